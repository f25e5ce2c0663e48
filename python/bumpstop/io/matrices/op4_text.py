"""OP4 files in text form.

Lines of one, two or three whole numbers announce strings and columns; lines of reals follow,
in fields of a fixed width that the header tells as a Fortran format.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.io.matrices.op4_columns import Op4Matrix, small_string

__all__ = ["read_text"]

_FORMAT = r"\d*[EDed](\d+)\.\d+"


def read_text(lines: list[str]) -> list[Op4Matrix]:
    """Return the matrices of an OP4 file in text form.

    Raises
    ------
    InputError
        If a line cannot be read, or the file ends within a matrix.
    """
    numbered = iter(enumerate(lines, start=1))
    matrices = []
    for number, line in numbered:
        if line:
            matrix, width = _header(number, line)
            _read_columns(matrix, width, numbered)
            matrices.append(matrix)
    return matrices


def _header(number: int, line: str) -> tuple[Op4Matrix, int]:
    """Return the matrix that a header announces, and the width of a real number."""
    try:
        sizes = [int(line[start : start + 8]) for start in range(0, 32, 8)]
    except ValueError as error:
        hint = "columns, rows, form and type of a matrix must stand there"
        raise InputError(
            "is not an OP4 file", key=f"line {number}", value=line, hint=hint
        ) from error
    columns, rows, form, kind = sizes
    found = re.search(_FORMAT, line[40:])
    return Op4Matrix(columns, rows, form, kind, line[32:40]), int(found[1]) if found else 16


def _read_columns(matrix: Op4Matrix, width: int, lines: Iterator[tuple[int, str]]) -> None:
    column = row = 0
    for number, line in lines:
        if "." in line:
            values = _reals(number, line, width)
            matrix.add(column, row, values)
            row += len(values)
            continue
        words = _whole_numbers(number, line)
        if len(words) == 3:
            column, row = words[:2]
            if column > matrix.shape[1]:
                next(lines, None)  # a number without meaning
                return
        elif len(words) == 2:
            row = words[1]
        else:
            row = small_string(words[0])[0]
    raise InputError(f"is truncated within matrix {matrix.name!r}")


def _reals(number: int, line: str, width: int) -> FloatArray:
    fields = [line[start : start + width] for start in range(0, len(line), width)]
    try:
        return np.array([float(field.replace("D", "E")) for field in fields])
    except ValueError as error:
        raise InputError("cannot be read", key=f"line {number}", value=line) from error


def _whole_numbers(number: int, line: str) -> list[int]:
    try:
        words = [int(word) for word in line.split()]
    except ValueError:
        words = []
    if not 1 <= len(words) <= 3:
        raise InputError("cannot be read", key=f"line {number}", value=line)
    return words
