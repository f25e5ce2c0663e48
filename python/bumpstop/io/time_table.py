"""Functions of time in text files: accelerograms, histories of forces.

Columns are parted by semicolons where there are any, else by tabs, commas or blanks, and a comma
between digits is a decimal one where semicolons or tabs part the columns. Lines that begin with
``#`` or ``%`` are remarks, and a first line that holds no numbers names the columns.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from bumpstop.arguments import FloatArray, did_you_mean
from bumpstop.errors import InputError, blamed
from bumpstop.io.reading import in_file, read_lines
from bumpstop.io.units import Dimension, si_factor

__all__ = ["read_time_table"]

_PARTED = r"[,;\s]+"
_DECIMAL_COMMA = r"(?<=\d),(?=\d)"
_REMARKS = ("#", "%")
_TIME = Dimension("a time", "s", "10 ms")


def read_time_table(
    path: Path,
    *,
    columns: Sequence[float | str] | None = None,
    step: float | None = None,
    units: Sequence[str] | None = None,
    skip: int = 0,
) -> tuple[FloatArray, FloatArray]:
    """Read times and values.

    Parameters
    ----------
    path
        The file.
    columns
        Of times and of values, by number from 1 or by name; the first two where left out.
    step
        Time between values in s, for a file without times: all its numbers are values.
    units
        Those of times and of values; SI where left out.
    skip
        How many lines at the head of the file are passed over.

    Returns
    -------
    tuple
        Times in s and values, (K,) each.

    Raises
    ------
    InputError
        If the file cannot be read, has no such columns, a line holds something else, or a unit
        is unknown.
    """
    in_time, in_value = 1.0, 1.0
    if units is not None:
        with blamed("units"):
            in_time, in_value = si_factor(units[0], _TIME), si_factor(units[1])
    times, values = _read(path, columns, step, skip)
    return times if step is not None else in_time * times, in_value * values


def _read(
    path: Path, columns: Sequence[float | str] | None, step: float | None, skip: int
) -> tuple[FloatArray, FloatArray]:
    """Return times and values as the file has them."""
    with in_file(path):
        rows = _rows(path, skip)
        names = [] if not rows or _is_numbers(rows[0][1]) else rows.pop(0)[1]
        if not rows:
            raise InputError("holds no numbers", hint="one line for each time, like '0.01, 2.5'")
        if step is not None:
            if columns is not None:
                raise InputError("has values alone where a step is given", key="columns")
            values = np.array([_number(n, word) for n, words in rows for word in words])
            return step * np.arange(len(values), dtype=np.float64), values
        first, second = _places(columns, names, len(rows[0][1]))
        least = max(first, second) + 1
        for number, words in rows:
            if len(words) < least:
                what = f"line {number} has {_columns(len(words))}, but {least} are needed"
                raise InputError(what, value=" ".join(words[:6]))
        picked = [(_number(n, words[first]), _number(n, words[second])) for n, words in rows]
        table = np.array(picked)
        return np.ascontiguousarray(table[:, 0]), np.ascontiguousarray(table[:, 1])


def _rows(path: Path, skip: int) -> list[tuple[int, list[str]]]:
    """Return the lines that are no remarks, in words, with their numbers."""
    lines = ((n, line.strip()) for n, line in enumerate(read_lines(path, "a table"), start=1))
    kept = [(n, line) for n, line in lines if n > skip and line and not line.startswith(_REMARKS)]
    mark = next((mark for mark in (";", "\t") if any(mark in line for _, line in kept)), None)
    if mark is None or not any(re.search(_DECIMAL_COMMA, line) for _, line in kept):
        parted = re.compile(_PARTED)
        return [(n, parted.split(line.strip(",;"))) for n, line in kept]
    with_points = ((n, re.sub(_DECIMAL_COMMA, ".", line).strip(mark)) for n, line in kept)
    return [(n, [word.strip() for word in line.split(mark)]) for n, line in with_points]


def _places(columns: Sequence[float | str] | None, names: list[str], count: int) -> tuple[int, int]:
    """Return where in a line time and value stand, from 0."""
    if columns is None:
        if count < 2:
            hint = "give the step between its values, or columns of times and values"
            raise InputError(f"has {_columns(count)}, not times and values", hint=hint)
        return 0, 1
    if len(columns) != 2:
        raise InputError("must be two columns, of times and of values", key="columns")
    first, second = (_place(column, names, count) for column in columns)
    return first, second


def _place(column: float | str, names: list[str], count: int) -> int:
    if isinstance(column, str):
        if column not in names:
            hint = did_you_mean(column, names)
            raise InputError("has no such column", key="columns", value=column, hint=hint)
        return names.index(column)
    if column != int(column) or not 1 <= column <= count:
        hint = f"they are numbered 1 to {count}"
        raise InputError("has no such column", key="columns", value=column, hint=hint)
    return int(column) - 1


def _columns(count: int) -> str:
    return f"{count} column" if count == 1 else f"{count} columns"


def _is_numbers(words: list[str]) -> bool:
    try:
        return bool([float(word) for word in words])
    except ValueError:
        return False


def _number(line: int, word: str) -> float:
    try:
        return float(word)
    except ValueError:
        raise InputError(f"line {line} holds no number", value=word) from None
