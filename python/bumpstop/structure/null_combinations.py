"""What a sparse set of sums lets be: all x with ``zeros @ x = 0``.

Unknowns that no sum couples are looked at apart. A few of them are eliminated densely, which
keeps simple solutions simple. Many are counted by the inertia of the normal matrix: a braced
truss has no solution, which is then known at once. Solutions that there are come from a few
steps of inverse iteration, and are then refined on the sums themselves.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bumpstop._core import SparseFactor
from bumpstop.arguments import FloatArray
from bumpstop.structure.echelon import independent_rows, null_space
from bumpstop.structure.graph import components
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["null_combinations"]

_FEW = 100
"""Most unknowns that are eliminated densely."""

_ROUNDING = 1e-13
"""Eigenvalues of the normal matrix below this are zero; sums come with weights of order one."""


_SHIFT = 1e-10
"""By how much the normal matrix is made definite for inverse iteration."""

_NOTHING = 1e-12
"""Parts of a solution this small are rounding."""


def null_combinations(zeros: SparseMatrix) -> FloatArray:
    """Return a basis of all x with ``zeros @ x = 0``, one vector a column.

    Parameters
    ----------
    zeros
        Sums that are to be zero, one a row, with weights of order one.

    Examples
    --------
    >>> pair = np.array([0, 0]), np.array([0, 2]), np.array([1.0, -1.0])
    >>> null_combinations(SparseMatrix.from_triplets((1, 3), *pair))
    array([[1., 0.],
           [0., 1.],
           [1., 0.]])
    """
    size = zeros.shape[1]
    held = np.zeros(size, dtype=bool)
    alone = np.bincount(zeros.rows, minlength=zeros.shape[0]) == 1
    held[zeros.columns[alone[zeros.rows]]] = True
    left = zeros.where(~held[zeros.columns])
    vectors = [np.zeros((size, 0))]
    for group in _groups(left, ~held):
        own = _few(left, group) if len(group) <= _FEW else _many(left, group)
        if own.shape[1]:
            vectors.append(np.zeros((size, own.shape[1])))
            vectors[-1][group] = own
    return np.hstack(vectors)


def _groups(zeros: SparseMatrix, wanted: NDArray[np.bool_]) -> list[IndexArray]:
    """Return the wanted unknowns, in groups that sums couple."""
    size = zeros.shape[1]
    together = components(size + zeros.shape[0], zeros.columns, size + zeros.rows)
    groups = [group[: np.searchsorted(group, size)] for group in together]
    return [group for group in groups if len(group) and wanted[group[0]]]


def _few(zeros: SparseMatrix, group: IndexArray) -> FloatArray:
    _, matrix = zeros.dense_columns(group)
    return null_space(matrix)


def _many(zeros: SparseMatrix, group: IndexArray) -> FloatArray:
    size = len(group)
    sums = zeros.times(SparseMatrix.selection(zeros.shape[1], group))
    normal = sums.transposed().times(sums)
    number = _shifted(normal, -_ROUNDING).negative_pivots
    if number == 0:
        return np.zeros((size, 0))
    chosen = np.zeros(size, dtype=bool)
    chosen[independent_rows(_lowest(normal, number))] = True
    return _completed(sums, normal, np.flatnonzero(chosen), np.flatnonzero(~chosen))


def _lowest(normal: SparseMatrix, number: int) -> FloatArray:
    """Return about the eigenvectors of lowest eigenvalue, by inverse iteration."""
    size = normal.shape[0]
    factor = _shifted(normal, _SHIFT)
    vectors = np.random.default_rng(0).normal(size=(size, number))
    for _ in range(8):
        vectors = np.linalg.qr(factor.solve(np.ascontiguousarray(vectors)))[0]
    return vectors


def _completed(
    sums: SparseMatrix, normal: SparseMatrix, chosen: IndexArray, others: IndexArray
) -> FloatArray:
    """Return the solutions in which the chosen unknowns are one, each in turn."""
    factor = SparseFactor(normal.restricted(others).arrays)
    solutions = np.zeros((sums.shape[1], len(chosen)))
    solutions[chosen, np.arange(len(chosen))] = 1.0
    across = sums.transposed()
    for _ in range(3):  # each step takes away the rounding that the one before left
        left = across @ (sums @ solutions)
        solutions[others] -= factor.solve(np.ascontiguousarray(left[others]))
    solutions[np.abs(solutions) < _NOTHING] = 0.0
    return solutions


def _shifted(matrix: SparseMatrix, shift: float) -> SparseFactor:
    size = matrix.shape[0]
    diagonal = SparseMatrix.selection(size, np.arange(size)).scaled(shift)
    return SparseFactor(matrix.plus(diagonal).arrays)
