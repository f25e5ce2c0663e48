"""Universal files (.uff, .unv): the data sets that a file is made of.

Format: "Universal File Datasets Summary", Structural Dynamics Research Laboratory, University of
Cincinnati. A data set stands between two lines that hold nothing but -1; its first line is its
number.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate, pairwise
from pathlib import Path
from typing import NamedTuple

from bumpstop.errors import InputError
from bumpstop.io.reading import read_lines

__all__ = ["DataSet", "Units", "data_sets", "file_units"]

_FENCE = "-1"


class DataSet(NamedTuple):
    """One data set: its number, and its lines after that."""

    number: int
    line: int
    """Of the file, of the first of ``lines``."""
    lines: list[str]

    def text(self, index: int) -> str:
        """Return a line; InputError where the data set ends before it."""
        if index >= len(self.lines):
            what = f"data set {self.number} is truncated"
            raise InputError(what, key=f"line {self.line + len(self.lines)}")
        return self.lines[index]

    def integers(self, index: int, least: int, *, end: int | None = None) -> list[int]:
        """Return the whole numbers of a line up to a column, in fields of ten characters."""
        text = self.text(index)[:end]
        return [int(number) for number in self._numbers(index, _cut(text, 10), least, whole=True)]

    def reals(self, index: int, least: int, width: int = 13, *, start: int = 0) -> list[float]:
        """Return the real numbers of a line from a column on, in fields of a width."""
        fields = _cut(self.text(index)[start:], width)
        return self._numbers(index, fields, least, whole=False)

    def fields(self, index: int, widths: Sequence[int]) -> list[float]:
        """Return the real numbers of a line, in fields of these widths, as far as it goes."""
        text = self.text(index)
        ends = [*accumulate(widths, initial=0)]
        fields = [text[start:end] for start, end in pairwise(ends) if start < len(text)]
        return self._numbers(index, fields, 1, whole=False)

    def _numbers(
        self, index: int, fields: Sequence[str], least: int, *, whole: bool
    ) -> list[float]:
        try:
            numbers = [_number(field, whole=whole) for field in fields]
        except ValueError:
            numbers = []
        if len(numbers) < least:
            place = f"line {self.line + index}"
            what = f"data set {self.number} cannot be read here"
            raise InputError(what, key=place, value=self.text(index))
        return numbers


def _cut(text: str, width: int) -> list[str]:
    return [text[start : start + width] for start in range(0, len(text), width)]


def _number(field: str, *, whole: bool) -> float:
    return int(field) if whole else float(field.upper().replace("D", "E"))


def data_sets(path: Path) -> list[DataSet]:
    """Return the data sets of a universal file in text form.

    Raises
    ------
    InputError
        If it has none, or ends within one.
    """
    found: list[DataSet] = []
    start: int | None = None
    lines = read_lines(path, "a universal file in text form")
    for index, line in enumerate(lines):
        if line.strip() != _FENCE or len(line) - len(line.lstrip()) != 4:
            continue
        if start is None:
            start = index + 1
        else:
            found.append(_data_set(start, lines[start:index]))
            start = None
    if start is not None:
        raise InputError(f"is truncated within the data set that begins at line {start + 1}")
    if not found:
        raise InputError("is not a universal file: it has no data set")
    return found


def _data_set(start: int, lines: list[str]) -> DataSet:
    number = lines[0].strip() if lines else ""
    if not number.isdecimal():
        what = "a data set must begin with its number"
        raise InputError(what, key=f"line {start + 1}", value=number)
    return DataSet(int(number), start + 2, lines[1:])


class Units(NamedTuple):
    """What numbers of the file must be divided by to be in SI units."""

    length: float
    force: float

    @property
    def mass(self) -> float:
        """The same for masses: force times time squared, by length."""
        return self.force / self.length


def file_units(found: list[DataSet]) -> Units:
    """Return the units that data set 164 tells; SI where there is none.

    Raises
    ------
    InputError
        If a factor is not positive.
    """
    for data in found:
        if data.number == 164:
            length, force = data.reals(1, 3, width=25)[:2]
            if not (length > 0.0 and force > 0.0):
                raise InputError("a unit must be positive", key=f"line {data.line + 1}")
            return Units(length, force)
    return Units(1.0, 1.0)
