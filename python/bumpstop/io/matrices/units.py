"""Matrices in other units than SI: consistent ones, such as mm, N and t."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from bumpstop.arguments import positive
from bumpstop.io.matrices.dof_map import DofMap
from bumpstop.structure.dofs import Dof
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["matrix_in_si", "places_in_si"]


def matrix_in_si(
    matrix: SparseMatrix, dofs: Sequence[Dof], *, length: float, force: float
) -> SparseMatrix:
    """Return a matrix in SI units whose unit of time is the second.

    Entries for two displacements are forces by length, those for two rotations forces times
    length; a mass is a force times the square of a second by length.

    Parameters
    ----------
    matrix
        Stiffness, mass, damping or another matrix on ``dofs``.
    dofs
        Node and dof of each row.
    length, force
        The units of the matrix, in m and N.

    Raises
    ------
    InputError
        If a unit is not positive.

    Examples
    --------
    A spring of 18 N/mm has 18 kN/m.

    >>> from bumpstop.structure.given import given_matrix
    >>> spring = given_matrix("spring", [[18.0]])
    >>> matrix_in_si(spring, [("P", "dx")], length=1e-3, force=1.0).values
    array([18000.])
    """
    arm = positive("length", length)
    turns = np.array([arm if dof.startswith("dr") else 1.0 for _, dof in dofs])
    scale = (turns[matrix.rows] * turns[matrix.columns]) * (positive("force", force) / arm)
    return SparseMatrix(matrix.shape, matrix.starts, matrix.rows, matrix.values * scale)


def places_in_si(dof_map: DofMap, length: float) -> DofMap:
    """Return a dof map with its coordinates in m."""
    places = {
        node: (length * x, length * y, length * z) for node, (x, y, z) in dof_map.positions.items()
    }
    return DofMap(dof_map.dofs, places, dof_map.fixed)
