"""Pseudo-static modes: how a structure follows supports that move slowly."""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.modal.solve import StaticSolver
from bumpstop.structure.model import LinearModel

__all__ = ["pseudo_static"]

_BALANCED = 1e-6
"""A force left on a dof that nothing holds, beside the largest of its row, is no rounding."""


def pseudo_static(model: LinearModel, moved: FloatArray) -> FloatArray:
    """Return the displacements of all dofs where held ones move and no load acts, (dofs,).

    Parameters
    ----------
    model
        The structure.
    moved
        How far each held dof moves, and zero for the others, (dofs,).

    Raises
    ------
    InputError
        If what moves carries parts without mass, or is joined to others by relations.

    References
    ----------
    R. W. Clough, J. Penzien, Dynamics of Structures, 3rd edition, 2003, section 26-3.
    """
    expansion, stiffness = model.expansion, model.stiffness
    pulled = stiffness @ moved
    solver = StaticSolver(model.reduced(stiffness), model.rigid_shapes())
    load = -(expansion.transposed() @ pulled)
    field = moved + expansion @ solver.solve(load[:, np.newaxis])[:, 0]
    following = np.zeros(len(field), dtype=bool)
    following[expansion.rows] = True
    left = np.abs(stiffness @ field)
    size = stiffness.magnitudes() @ np.abs(field)
    if np.any(following & (left > _BALANCED * size) & (left > _BALANCED * size.max())):
        number = int(np.argmax(np.where(following, left, 0.0)))
        node, dof = model.dofs[number]
        what = f"leaves a force on {node} {dof}, which has no mass or is told by other dofs"
        raise InputError(what, hint="give the node mass, or move the support in another way")
    return field
