"""Coupling: the coordinates of parts that joints and supports leave independent."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.echelon import null_space
from bumpstop.structure.graph import components
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["Coupling", "coupling"]


class Coupling(NamedTuple):
    """All coordinates x by the independent ones among them: x = expansion @ x[leading]."""

    leading: IndexArray
    """Which of the coordinates are independent, ascending."""
    expansion: SparseMatrix
    """All by these, (coordinates, independent ones)."""


def coupling(equations: FloatArray) -> Coupling:
    """Return all coordinates x with ``equations @ x = 0``.

    Elimination keeps what is plain plain: two coordinates that are tied become one, with ones
    in the expansion. Those that no equation ties together are treated apart, so that the work
    grows with the number of joints and not with its cube.

    Parameters
    ----------
    equations
        One a row, (equations, coordinates), with entries of order one.

    Examples
    --------
    >>> leading, expansion = coupling(np.array([[1.0, 0.0, -1.0]]))
    >>> leading, expansion.to_dense()
    (array([0, 1]), array([[1., 0.],
           [0., 1.],
           [1., 0.]]))
    """
    count, size = equations.shape
    rows, columns = np.nonzero(equations)
    leading, entries = [], []
    for group in map(np.array, components(count + size, rows, count + columns)):
        tied = group[group >= count] - count
        independent = null_space(equations[np.ix_(group[group < count], tied)])
        first = _unit_rows(independent)
        row, column = np.nonzero(independent)
        leading.append(tied[first])
        entries.append((tied[row], tied[first][column], independent[row, column]))
    ascending = np.sort(np.concatenate(leading))
    rows, leads, values = (np.concatenate(parts) for parts in zip(*entries, strict=True))
    columns = np.searchsorted(ascending, leads)
    shape = (size, len(ascending))
    return Coupling(ascending, SparseMatrix.from_triplets(shape, rows, columns, values))


def _unit_rows(matrix: FloatArray) -> IndexArray:
    """Return the first row, for each column, that is one there and zero in the others."""
    unit = (matrix == 1.0) & (np.count_nonzero(matrix, axis=1) == 1)[:, np.newaxis]
    first: IndexArray = unit.argmax(axis=0)
    return first
