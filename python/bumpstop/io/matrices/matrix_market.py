"""Matrix Market files (.mtx): the exchange format of NIST, read and written.

Format: R. F. Boisvert, R. Pozo, K. A. Remington, "The Matrix Market Exchange Formats: Initial
Design", NISTIR 5935, 1996.
"""

from __future__ import annotations

from io import StringIO
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.files import written_whole
from bumpstop.io.matrices.triplets import mirrored
from bumpstop.io.reading import MOST_ROWS, in_file, read_lines
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["BANNER", "read_matrix_market", "write_matrix_market"]

BANNER = "%%matrixmarket"
_KIND = "a Matrix Market file"
_SIGNS = {"general": 0.0, "symmetric": 1.0, "hermitian": 1.0, "skew-symmetric": -1.0}


class _Header(NamedTuple):
    layout: str
    field: str
    sign: float
    """Of the mirrored half; zero where all entries are given."""


def read_matrix_market(path: Path) -> SparseMatrix:
    """Read a real matrix, sparse (``coordinate``) or dense (``array``).

    Raises
    ------
    InputError
        If the file cannot be read, is not in this format, is truncated, or is not real.
    """
    with in_file(path):
        lines = read_lines(path, _KIND)
        header = _header(lines[0])
        body = [line for line in lines[1:] if line and not line.lstrip().startswith("%")]
        if not body:
            raise InputError("is truncated: it gives no size", hint=_SIZES[header.layout])
        sizes = _sizes(body[0], header.layout)
        if header.sign and sizes[0] != sizes[1]:
            raise InputError("is announced as symmetric but is not square", value=body[0])
        numbers = _numbers(body[1:])
        read = _coordinates if header.layout == "coordinate" else _array
        return read(header, sizes, numbers)


_SIZES = {
    "coordinate": "after the comments come rows, columns and the number of entries",
    "array": "after the comments come the numbers of rows and columns",
}


def _header(line: str) -> _Header:
    words = line.lower().split()
    if len(words) != 5 or words[0] != BANNER or words[1] != "matrix":
        hint = "the first line must be like '%%MatrixMarket matrix coordinate real general'"
        raise InputError(f"is not {_KIND}", key="line 1", value=line, hint=hint)
    layout, field, symmetry = words[2:]
    if layout not in _SIZES:
        raise InputError("unknown layout", key="line 1", value=layout)
    if field not in ("real", "integer", "double", "complex"):
        raise InputError("has no real values", key="line 1", value=field)
    if symmetry not in _SIGNS:
        raise InputError("unknown symmetry", key="line 1", value=symmetry)
    return _Header(layout, field, _SIGNS[symmetry])


def _sizes(line: str, layout: str) -> list[int]:
    words = line.split()
    wanted = 3 if layout == "coordinate" else 2
    if len(words) != wanted or not all(word.isdecimal() for word in words):
        raise InputError("the sizes cannot be read", value=line, hint=_SIZES[layout])
    sizes = [int(word) for word in words]
    if max(sizes[:2]) > MOST_ROWS:
        raise InputError(f"announces more than {MOST_ROWS:,} rows", value=max(sizes[:2]))
    return sizes


def _numbers(lines: list[str]) -> FloatArray:
    """Return the numbers of all lines, as many in each."""
    if not lines:
        return np.zeros((0, 0))
    text = "\n".join(lines).upper().replace("D", "E")  # Fortran's double precision
    try:
        return np.loadtxt(StringIO(text), ndmin=2, dtype=np.float64)
    except ValueError as error:
        raise InputError(f"an entry cannot be read: {_first_sentence(error)}") from error


def _first_sentence(error: ValueError) -> str:
    return str(error).partition(";")[0].rstrip(".")


def _coordinates(header: _Header, sizes: list[int], numbers: FloatArray) -> SparseMatrix:
    rows, columns, announced = sizes
    if len(numbers) != announced:
        what = f"announces {announced} entries but holds {len(numbers)}"
        raise InputError(what, hint="is it truncated?")
    if announced == 0:
        numbers = np.zeros((0, 4 if header.field == "complex" else 3))
    values = _real(header, numbers[:, 2:])
    row, column = numbers[:, 0].astype(np.intp) - 1, numbers[:, 1].astype(np.intp) - 1
    outside = (row < 0) | (row >= rows) | (column < 0) | (column >= columns)
    if outside.any():
        entry = int(outside.argmax())
        place = f"({row[entry] + 1}, {column[entry] + 1})"
        raise InputError(f"entry {entry + 1} is at {place}, outside of {rows} x {columns}")
    if header.sign:
        row, column, values = mirrored(row, column, values, header.sign)
    return SparseMatrix.from_triplets((rows, columns), row, column, values)


def _array(header: _Header, sizes: list[int], numbers: FloatArray) -> SparseMatrix:
    rows, columns = sizes
    strict = int(header.sign < 0.0)
    announced = rows * (rows + 1 - 2 * strict) // 2 if header.sign else rows * columns
    if len(numbers) != announced:
        what = f"announces {announced} entries but holds {len(numbers)}"
        raise InputError(what, hint="is it truncated?")
    if header.sign:
        column, row = np.triu_indices(rows, strict)
    else:
        column, row = np.divmod(np.arange(announced), max(rows, 1))
    values = _real(header, numbers) if announced else np.zeros(0)
    if header.sign:
        row, column, values = mirrored(row, column, values, header.sign)
    return SparseMatrix.from_triplets((rows, columns), row, column, values)


def _real(header: _Header, numbers: FloatArray) -> FloatArray:
    wanted = 2 if header.field == "complex" else 1
    if numbers.shape[1] != wanted:
        raise InputError(f"each entry must have {wanted} value(s), not {numbers.shape[1]}")
    if header.field == "complex" and numbers[:, 1].any():
        raise InputError("must be real, not complex")
    return numbers[:, 0]


def write_matrix_market(path: Path, matrix: SparseMatrix, *, skew: bool = False) -> None:
    """Write a symmetric or skew-symmetric matrix, its lower triangle, with all digits.

    Raises
    ------
    InputError
        If nothing can be written there.
    """
    rows, columns = matrix.rows, matrix.columns
    lower = rows >= columns
    entries = zip(
        (rows[lower] + 1).tolist(),
        (columns[lower] + 1).tolist(),
        matrix.values[lower].tolist(),
        strict=True,
    )
    symmetry = "skew-symmetric" if skew else "symmetric"
    with written_whole(path) as part, part.open("w", encoding="ascii", newline="\n") as file:
        file.write(f"%%MatrixMarket matrix coordinate real {symmetry}\n")
        file.write(f"{matrix.shape[0]} {matrix.shape[1]} {int(lower.sum())}\n")
        file.writelines(f"{row} {column} {value!r}\n" for row, column, value in entries)
