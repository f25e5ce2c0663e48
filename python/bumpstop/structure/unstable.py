"""Motions without inertia that a stiffness pushes away instead of holding them."""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.graph import components
from bumpstop.structure.massless import MOST_CONDENSED
from bumpstop.structure.null_motions import is_definite
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["unstable_motion"]

_ROUNDING = 1e-9
"""Of a stiffness of unit diagonal, negative eigenvalues of this size are rounding."""

_BALANCED = 1e-4
"""Forces this small beside the sizes of their terms are none: what holds a motion by itself with
rounding alone may hold it against others with the square root of that."""


def unstable_motion(
    motions: SparseMatrix, idle: SparseMatrix, stiffness: SparseMatrix
) -> FloatArray | None:
    """Return a massless motion of the free dofs (dofs,) that is not held, if there is one.

    Without inertia it would move away at once: no equilibrium can be followed.

    Parameters
    ----------
    motions
        Motions without inertia, (free dofs, motions).
    idle
        Those that do no work on the stiffness; what is in equilibrium feels no force either.
    stiffness
        Stiffness of the free dofs.

    Examples
    --------
    >>> second = SparseMatrix.selection(2, np.array([1]))
    >>> none = SparseMatrix.selection(2, np.array([], dtype=np.intp))
    >>> diagonal = np.array([0, 1]), np.array([0, 1])
    >>> springs = SparseMatrix.from_triplets((2, 2), *diagonal, np.array([3.0, -1.0]))
    >>> unstable_motion(second, none, springs)
    array([0., 1.])
    """
    forces = stiffness.times(idle)
    sizes = stiffness.magnitudes().times(idle.magnitudes()).values
    acting = np.flatnonzero(np.abs(forces.values) > _BALANCED * sizes)
    if len(acting):
        return _field(idle, forces.columns[acting[:1]], np.ones(1))
    own = stiffness.congruent(motions)
    for group in components(own.shape[0], own.rows, own.columns):
        matrix = own.restricted(group).to_dense()
        if len(group) <= MOST_CONDENSED and not is_definite(matrix, -_ROUNDING):
            return _field(motions, group, np.linalg.eigh(matrix)[1][:, 0])
    return None


def _field(motions: SparseMatrix, numbers: IndexArray, weights: FloatArray) -> FloatArray:
    """Return the weighted sum of some motions."""
    moved, fields = motions.dense_columns(numbers)
    field = np.zeros(motions.shape[0])
    field[moved] = fields @ weights
    return field
