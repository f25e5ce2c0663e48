"""Static solutions: displacements under loads, with the stiffness matrix factorised once."""

from __future__ import annotations

import numpy as np

from bumpstop._core import CoreError, SparseFactor
from bumpstop.arguments import FloatArray
from bumpstop.errors import ComputationError
from bumpstop.structure.echelon import independent_rows
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["StaticSolver"]


class StaticSolver:
    """Solves ``K x = f`` for many right-hand sides.

    A structure that can move as a rigid body has no unique solution, and none at all unless
    the load is in balance. For a load in balance, ``solve`` returns the solution that keeps
    still as many well chosen dofs as there are rigid motions; add rigid motions as needed.

    Parameters
    ----------
    stiffness
        Symmetric matrix (n, n).
    rigid
        All motions that the matrix does not resist, (n, r); none where left out.

    Raises
    ------
    ComputationError
        If the matrix is singular beyond the rigid motions.
    """

    def __init__(self, stiffness: SparseMatrix, rigid: FloatArray | None = None) -> None:
        size = stiffness.shape[0]
        moving = np.ones(size, dtype=bool)
        if rigid is not None:
            moving[independent_rows(rigid)] = False
        self._moving = np.flatnonzero(moving)
        self._factor = _factored(stiffness.restricted(self._moving))

    def solve(self, loads: FloatArray) -> FloatArray:
        """Return the displacements (n, m) under loads (n, m)."""
        displacements = np.zeros(loads.shape)
        inner = np.ascontiguousarray(loads[self._moving])
        displacements[self._moving] = self._factor.solve(inner)
        return displacements


def _factored(matrix: SparseMatrix) -> SparseFactor:
    try:
        factor = SparseFactor((matrix.starts, matrix.rows, matrix.values))
    except CoreError as error:
        raise ComputationError(f"the stiffness matrix cannot be factored: {error}") from error
    if factor.singular_at is not None:
        raise ComputationError("the stiffness matrix is singular")
    return factor
