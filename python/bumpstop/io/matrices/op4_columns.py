"""What text and binary OP4 files have in common: headers, and strings of columns.

Format: MSC Nastran, DMAP Programmer's Guide, module OUTPUT4. Of each column the file gives
strings of consecutive rows. A string of a sparse matrix is announced by one word,
row + 65536 (length + 1), or by two, length + 1 and row, where the matrix is large (BIGMAT,
told by a negative number of rows). The column after the last one ends the matrix.
"""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.io.matrices.triplets import mirrored
from bumpstop.io.reading import MOST_ROWS
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["Op4Matrix", "small_string"]

_SYMMETRIC = 6
_REAL = (1, 2)


def small_string(word: int) -> tuple[int, int]:
    """Return first row, counted from 1, and number of words that one word announces."""
    length = word // 65536 - 1
    return word - 65536 * (length + 1), length


class Op4Matrix:
    """A matrix as its strings come in.

    Parameters
    ----------
    columns, rows
        Its size; rows negative for a large sparse one.
    form
        6 for a symmetric matrix, of which one triangle may stand for both.
    kind
        1 and 2 for real numbers in single and double precision.
    name
        What the file calls it.

    Raises
    ------
    InputError
        If the header makes no sense, or the matrix is complex.
    """

    def __init__(self, columns: int, rows: int, form: int, kind: int, name: str) -> None:
        self.name, self.form, self.kind = name.strip(), form, kind
        self.shape = (abs(rows), columns)
        self.big = rows < 0
        if not (0 < columns <= MOST_ROWS and 0 < abs(rows) <= MOST_ROWS):
            raise InputError(f"{self.name!r} announces {abs(rows)} rows and {columns} columns")
        if kind not in _REAL:
            raise InputError(f"{self.name!r} must be real, not complex", value=f"type {kind}")
        self._rows: list[int] = []
        self._columns: list[int] = []
        self._strings: list[FloatArray] = []

    def add(self, column: int, row: int, values: FloatArray) -> None:
        """Add a string of consecutive rows, counted from 1 like the column."""
        if not (1 <= column <= self.shape[1] and 1 <= row <= self.shape[0] - len(values) + 1):
            place = f"rows {row} to {row + len(values) - 1} of column {column}"
            raise InputError(f"{self.name!r} has {place}, which is outside of it")
        self._rows.append(row - 1)
        self._columns.append(column - 1)
        self._strings.append(values)

    def assembled(self) -> SparseMatrix:
        """Return the matrix; both triangles of a symmetric one."""
        lengths = np.array([len(values) for values in self._strings], dtype=np.intp)
        first, columns = (
            np.repeat(np.array(places, dtype=np.intp), lengths)
            for places in (self._rows, self._columns)
        )
        rows = first + _counted(lengths)
        values = np.concatenate([np.zeros(0), *self._strings])
        stored = values != 0.0
        rows, columns, values = rows[stored], columns[stored], values[stored]
        one_sided = not (np.any(rows < columns) and np.any(rows > columns))
        if self.form == _SYMMETRIC and one_sided:
            rows, columns, values = mirrored(rows, columns, values)
        return SparseMatrix.from_triplets(self.shape, rows, columns, values)


def _counted(lengths: IndexArray) -> IndexArray:
    """Return 0, 1, 2, ... up to each length."""
    ends = np.cumsum(lengths)
    return np.arange(ends[-1] if len(ends) else 0) - np.repeat(ends - lengths, lengths)
