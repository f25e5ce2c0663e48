"""From the matrices of parts to the matrices of the structure."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.mesh import Mesh
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["Block", "Part", "assembled"]


@dataclass(frozen=True, eq=False)
class Block:
    """Matrices that one part adds to the structure's, in global axes.

    A part of equal elements gives their matrices once, and where they go.

    Parameters
    ----------
    dofs
        Numbers of the dofs of each element, (elements, n).
    stiffness, mass, damping
        Symmetric matrices of one element, (n, n); None for zero.
    gyroscopic, circulatory
        Skew-symmetric matrices of one element, (n, n), that multiply velocities and
        displacements; None for zero.
    """

    dofs: IndexArray
    stiffness: FloatArray | None = None
    mass: FloatArray | None = None
    damping: FloatArray | None = None
    gyroscopic: FloatArray | None = None
    circulatory: FloatArray | None = None


class Part(Protocol):
    """Whatever has stiffness or mass: all that a structure asks of a beam or a mass."""

    def block(self, mesh: Mesh) -> Block:
        """Return the part's matrices on the dofs of ``mesh``."""


def assembled(pieces: Iterable[tuple[IndexArray, FloatArray | None]], size: int) -> SparseMatrix:
    """Add up element matrices (n, n), each at all places of its dofs (elements, n)."""
    triplets = [_triplets(dofs, matrix) for dofs, matrix in pieces if matrix is not None]
    if not triplets:
        triplets = [(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp), np.zeros(0))]
    rows, columns, values = (np.concatenate(column) for column in zip(*triplets, strict=True))
    return SparseMatrix.from_triplets((size, size), rows, columns, values)


def _triplets(dofs: IndexArray, matrix: FloatArray) -> tuple[IndexArray, IndexArray, FloatArray]:
    """Return rows, columns and values, without the zeros of the element matrix."""
    row, column = np.nonzero(matrix)
    values = np.tile(matrix[row, column], len(dofs))
    return dofs[:, row].ravel(), dofs[:, column].ravel(), values
