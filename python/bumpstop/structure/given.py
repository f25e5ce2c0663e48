"""Matrices from outside: whatever holds one becomes a checked SparseMatrix."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol, TypeAlias

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.structure.dofs import Dof
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["GivenMatrix", "given_matrix", "skew_matrix", "symmetric_matrix"]


class ScipyMatrix(Protocol):
    """A sparse matrix or array of SciPy, whatever its format."""

    def tocoo(self) -> Any:
        """Return the same as triplets."""


GivenMatrix: TypeAlias = SparseMatrix | ScipyMatrix | FloatArray | Sequence[Sequence[float]]
"""What users may hand over as a matrix."""


def given_matrix(key: str, given: GivenMatrix) -> SparseMatrix:
    """Return a matrix in compressed columns, without the zeros that it stores.

    Parameters
    ----------
    key
        What the matrix is called in messages.
    given
        A SparseMatrix, a sparse matrix or array of SciPy, or a dense array.

    Raises
    ------
    InputError
        If it is not a real matrix.

    Examples
    --------
    >>> given_matrix("stiffness", [[2.0, -1.0], [-1.0, 0.0]]).values
    array([ 2., -1., -1.])
    """
    if isinstance(given, SparseMatrix):
        return _without_zeros(given.shape, given.rows, given.columns, given.values)
    if hasattr(given, "tocoo"):
        triplets = given.tocoo()
        shape, rows, columns = triplets.shape, triplets.row, triplets.col
        return _without_zeros(shape, rows, columns, _real(key, triplets.data))
    dense = _real(key, given)
    if dense.ndim != 2:
        raise InputError("must be a matrix", key=key, value=f"an array of shape {dense.shape}")
    rows, columns = np.nonzero(dense)
    return _without_zeros(dense.shape, rows, columns, dense[rows, columns])


def symmetric_matrix(
    key: str, given: GivenMatrix, dofs: Sequence[Dof], accuracy: float
) -> SparseMatrix:
    """Return a square matrix of finite numbers that is symmetric to the last bit.

    Parameters
    ----------
    key
        What the matrix is called in messages.
    given
        The matrix.
    dofs
        Node and dof of each row.
    accuracy
        An asymmetry up to this fraction of the geometric mean of the two diagonal entries
        is rounding, and evened out.

    Raises
    ------
    InputError
        If it is not square or of the size of ``dofs``, not finite or not symmetric.
    """
    return _even(key, given_matrix(key, given), dofs, accuracy, 1.0)


def skew_matrix(key: str, given: GivenMatrix, dofs: Sequence[Dof], accuracy: float) -> SparseMatrix:
    """Return a square matrix of finite numbers that is its own negative transpose.

    Raises
    ------
    InputError
        If it is not square or of the size of ``dofs``, not finite or not skew-symmetric.
    """
    return _even(key, given_matrix(key, given), dofs, accuracy, -1.0)


def _even(
    key: str, matrix: SparseMatrix, dofs: Sequence[Dof], accuracy: float, sign: float
) -> SparseMatrix:
    """Return half the sum of a matrix and ``sign`` times its transpose."""
    _check_size(key, matrix, dofs)
    _check_finite(key, matrix, dofs)
    mirrored = _sum_with_mirror(matrix, -sign)
    if len(mirrored.values):
        _check_mirror(key, matrix, mirrored, dofs, accuracy, sign)
    return _sum_with_mirror(matrix, sign)


def _sum_with_mirror(matrix: SparseMatrix, sign: float) -> SparseMatrix:
    rows, columns, halves = matrix.rows, matrix.columns, 0.5 * matrix.values
    return _without_zeros(
        matrix.shape,
        np.concatenate([rows, columns]),
        np.concatenate([columns, rows]),
        np.concatenate([halves, sign * halves]),
    )


def _check_size(key: str, matrix: SparseMatrix, dofs: Sequence[Dof]) -> None:
    rows, columns = matrix.shape
    if rows != columns:
        raise InputError(f"must be square, not {rows} x {columns}", key=key)
    if rows != len(dofs):
        raise InputError(f"is {rows} x {rows}, but there are {len(dofs)} dofs", key=key)


def _check_finite(key: str, matrix: SparseMatrix, dofs: Sequence[Dof]) -> None:
    wrong = np.flatnonzero(~np.isfinite(matrix.values))
    if len(wrong):
        place = _place(dofs, matrix.rows[wrong[0]], matrix.columns[wrong[0]])
        value = float(matrix.values[wrong[0]])
        raise InputError(f"must be finite at {place}", key=key, value=value)


def _check_mirror(
    key: str,
    matrix: SparseMatrix,
    half_difference: SparseMatrix,
    dofs: Sequence[Dof],
    accuracy: float,
    sign: float,
) -> None:
    """Raise where entries and their mirrors differ by more than rounding."""
    rows, columns = half_difference.rows, half_difference.columns
    diagonal = np.abs(matrix.diagonal())
    mean = np.sqrt(diagonal[rows]) * np.sqrt(diagonal[columns])
    size = np.maximum(mean, np.abs(half_difference.values))
    excess = np.abs(half_difference.values) / size
    worst = int(excess.argmax())
    if excess[worst] <= 0.5 * accuracy:
        return
    kind = "symmetric" if sign > 0.0 else "skew-symmetric"
    row, column = sorted((int(rows[worst]), int(columns[worst])))
    entry, mirror = _entry(matrix, row, column), _entry(matrix, column, row)
    place = _place(dofs, row, column)
    raise InputError(
        f"must be {kind}, but is {entry:.6g} at {place} and {mirror:.6g} at its mirror", key=key
    )


def _entry(matrix: SparseMatrix, row: int, column: int) -> float:
    start, end = matrix.starts[column], matrix.starts[column + 1]
    inside = matrix.rows[start:end] == row
    return float(matrix.values[start:end][inside].sum())


def _place(dofs: Sequence[Dof], row: int, column: int) -> str:
    return f"({'.'.join(dofs[row])}, {'.'.join(dofs[column])})"


def _without_zeros(shape: tuple[int, int], rows: Any, columns: Any, values: Any) -> SparseMatrix:
    summed = SparseMatrix.from_triplets(
        (int(shape[0]), int(shape[1])),
        np.asarray(rows, dtype=np.intp),
        np.asarray(columns, dtype=np.intp),
        np.asarray(values, dtype=np.float64),
    )
    kept = summed.values != 0.0
    if kept.all():
        return summed
    return SparseMatrix.from_triplets(
        summed.shape, summed.rows[kept], summed.columns[kept], summed.values[kept]
    )


def _real(key: str, values: object) -> FloatArray:
    array = _array(key, values)
    if np.iscomplexobj(array):
        if np.any(array.imag):
            raise InputError("must be real, not complex", key=key)
        array = array.real
    if array.dtype.kind not in "fiub":
        raise InputError("must hold numbers", key=key, value=values)
    real: FloatArray = array.astype(np.float64)
    return real


def _array(key: str, values: object) -> Any:
    try:
        return np.asarray(values)
    except ValueError as error:  # rows of different lengths
        raise InputError("must be a matrix", key=key, value=values) from error
