"""Displacement fields turned about an axis by a right angle, node by node."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray, vector
from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS, Dof

__all__ = ["turned_fields", "unit_axis"]

ComplexArray: TypeAlias = NDArray[np.complex128]


def turned_fields(dofs: Sequence[Dof], fields: ComplexArray, axis: FloatArray) -> ComplexArray:
    """Return ``axis x u`` of the translation and of the rotation u of every node.

    Parameters
    ----------
    dofs
        Node and dof of each row; a component that has no row counts as zero.
    fields
        One a column, (rows, n).
    axis
        Direction of length one, (3,).
    """
    nodes = {node: number for number, node in enumerate(dict.fromkeys(node for node, _ in dofs))}
    places = np.array([6 * nodes[node] + DOFS.index(dof) for node, dof in dofs])
    whole = np.zeros((6 * len(nodes), fields.shape[1]), dtype=np.complex128)
    whole[places] = fields
    x, y, z = (whole.reshape(-1, 3, fields.shape[1])[:, i] for i in range(3))
    a, b, c = axis
    turned = np.stack([b * z - c * y, c * x - a * z, a * y - b * x], axis=1)
    rows: ComplexArray = turned.reshape(whole.shape)[places]
    return rows


def unit_axis(axis: object) -> FloatArray:
    """Return the direction of an axis, of length one.

    Raises
    ------
    InputError
        If it is not three finite numbers, or has no length.
    """
    direction = np.array(vector("axis", axis))
    length = float(np.linalg.norm(direction))
    if length == 0.0:
        raise InputError("must have a length", key="axis", value=axis)
    unit: FloatArray = direction / length
    return unit
