"""Null spaces and ranks of small matrices by elimination.

Elimination with complete pivoting keeps unit vectors unit vectors: the rigid motions that
supports allow come out as plain translations and rotations, without the rounding that an
orthogonal factorisation would mix in.
"""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray

__all__ = ["independent_columns", "independent_rows", "null_space", "row_space"]

_NEGLIGIBLE = 1e-9
"""Pivots below this are rounding; matrices must come with entries of order one."""


def null_space(matrix: FloatArray) -> FloatArray:
    """Return a basis of all x with ``matrix @ x = 0``, one vector a column.

    Examples
    --------
    >>> import numpy as np
    >>> null_space(np.array([[0.0, 1.0, 0.5]]))
    array([[ 1. ,  0. ],
           [-0. , -0.5],
           [ 0. ,  1. ]])
    """
    reduced, rows, columns = _eliminated(matrix)
    size = matrix.shape[1]
    # Not np.setdiff1d: it loads numpy.ma, which costs every run a few milliseconds.
    pivotal = np.zeros(size, dtype=bool)
    pivotal[columns] = True
    others = np.flatnonzero(~pivotal)
    basis = np.zeros((size, len(others)))
    basis[others, np.arange(len(others))] = 1.0
    basis[columns] = -reduced[rows][:, others]
    return basis


def independent_columns(matrix: FloatArray) -> FloatArray:
    """Return columns of a matrix that span all of them, in their order."""
    _, _, columns = _eliminated(matrix)
    return matrix[:, sorted(columns)]


def independent_rows(matrix: FloatArray) -> list[int]:
    """Return numbers of rows that determine all others, ascending.

    Examples
    --------
    >>> import numpy as np
    >>> independent_rows(np.array([[1.0, 0.0], [2.0, 0.0], [0.0, 1.0]]))
    [1, 2]
    """
    _, rows, _ = _eliminated(matrix)
    return sorted(rows)


def row_space(matrix: FloatArray) -> FloatArray:
    """Return independent rows that span those of a matrix, as simple as elimination makes them.

    Examples
    --------
    >>> import numpy as np
    >>> row_space(np.array([[1.0, -1.0], [-1.0, 1.0]]))
    array([[ 1., -1.]])
    """
    reduced, rows, _ = _eliminated(matrix)
    return reduced[rows]


def _eliminated(matrix: FloatArray) -> tuple[FloatArray, list[int], list[int]]:
    """Reduce the pivots' columns to unit vectors; return also the pivots' rows and columns."""
    reduced = matrix.copy()
    rows: list[int] = []
    columns: list[int] = []
    for _ in range(min(matrix.shape)):
        candidates = np.abs(reduced)
        candidates[rows] = 0.0
        row, column = (int(i) for i in np.unravel_index(candidates.argmax(), matrix.shape))
        if candidates[row, column] <= _NEGLIGIBLE:
            break
        reduced[row] /= reduced[row, column]
        factors = reduced[:, column].copy()
        factors[row] = 0.0
        reduced -= np.outer(factors, reduced[row])
        rows.append(row)
        columns.append(column)
    return reduced, rows, columns
