"""Static solutions: displacements under loads, with the stiffness matrix factorised once."""

from __future__ import annotations

import numpy as np

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
        self._matrix = stiffness.restricted(self._moving).to_dense()

    def solve(self, loads: FloatArray) -> FloatArray:
        """Return the displacements (n, m) under loads (n, m)."""
        displacements = np.zeros(loads.shape)
        try:
            displacements[self._moving] = np.linalg.solve(self._matrix, loads[self._moving])
        except np.linalg.LinAlgError as error:
            raise ComputationError("the stiffness matrix is singular") from error
        return displacements
