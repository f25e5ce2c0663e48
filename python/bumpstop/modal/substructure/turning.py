"""From a component's own axes to the global ones."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS, Dof
from bumpstop.structure.graph import components
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["mixed_dofs", "turnable", "turning_matrix"]


def turning_matrix(dofs: Sequence[Dof], rotation: FloatArray) -> SparseMatrix:
    """Return the matrix T that turns the dofs of all nodes: u_global = T u_own.

    Displacements and rotations of each node are vectors; of nodes that have only some of
    their components, the rotation must not mix these with the others.

    Raises
    ------
    InputError
        If it does.
    """
    numbers = {dof: number for number, dof in enumerate(dofs)}
    rows, columns, values = [], [], []
    for column, (node, dof) in enumerate(dofs):
        for weight, towards in _images(dof, rotation):
            if (node, towards) not in numbers:
                what = f"turns {dof} of {node!r} towards {towards}, which is not known there"
                raise InputError(what, key="rotation")
            rows.append(numbers[node, towards])
            columns.append(column)
            values.append(weight)
    shape, places = (len(dofs), len(dofs)), (np.array(rows, int), np.array(columns, int))
    return SparseMatrix.from_triplets(shape, *places, np.array(values, float))


def mixed_dofs(dof: str, rotation: FloatArray) -> list[str]:
    """Return the own dofs that a global one is made of.

    >>> mixed_dofs("dry", np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]))
    ['drx']
    """
    return [own for _, own in _images(dof, rotation.T)]


def turnable(dofs: Sequence[Dof], rotation: FloatArray) -> NDArray[np.bool_]:
    """Tell which dofs a rotation mixes with none but others of the list, (dofs,)."""
    known = set(dofs)
    groups = {axis: group for group in components(3, *np.nonzero(rotation)) for axis in group}
    fits = []
    for node, dof in dofs:
        kind, axis = divmod(DOFS.index(dof), 3)
        fits.append(all((node, DOFS[3 * kind + i]) in known for i in groups[axis]))
    return np.array(fits, dtype=bool)


def _images(dof: str, rotation: FloatArray) -> list[tuple[float, str]]:
    """Return what a unit of a dof becomes: weights and dofs."""
    if dof not in DOFS:  # the amplitude of a shape has no direction
        return [(1.0, dof)]
    kind, axis = divmod(DOFS.index(dof), 3)
    column = rotation[:, axis].tolist()
    return [(weight, DOFS[3 * kind + i]) for i, weight in enumerate(column) if weight != 0.0]
