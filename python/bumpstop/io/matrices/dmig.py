"""Nastran DMIG cards: matrices by grid and component, in bulk data and punch files.

Format: MSC Nastran, Quick Reference Guide, bulk data entry DMIG: a header per matrix, then a
card per column, in small (8), large (16) or free fields.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from bumpstop.errors import InputError
from bumpstop.io.matrices.triplets import FileMatrix, labelled_matrix
from bumpstop.io.reading import in_file, read_lines

__all__ = ["read_dmig"]

_SYMMETRIC = 6
_REAL = (1, 2)
_Label = tuple[int, int]


@dataclass
class _Entries:
    """A matrix as its cards come in."""

    form: int
    rows: list[_Label] = field(default_factory=list)
    columns: list[_Label] = field(default_factory=list)
    values: list[float] = field(default_factory=list)


def read_dmig(path: Path) -> dict[str, FileMatrix]:
    """Read all real matrices of a bulk data file, by name; other cards are passed over.

    Raises
    ------
    InputError
        If the file cannot be read, has no DMIG card, or a card makes no sense.
    """
    matrices: dict[str, _Entries] = {}
    with in_file(path):
        for number, fields in _cards(read_lines(path, "a Nastran bulk data file")):
            try:
                _take(matrices, fields)
            except InputError as error:
                raise error.located(key=f"line {number}") from error
            except (ValueError, IndexError) as error:
                what = "the card cannot be read"
                raise InputError(what, key=f"line {number}", value=" ".join(fields)) from error
        if not matrices:
            raise InputError("has no DMIG card")
        return {name: _matrix(name, entries) for name, entries in matrices.items()}


def _matrix(name: str, entries: _Entries) -> FileMatrix:
    if not entries.values:
        raise InputError(f"matrix {name!r} has no entries", hint="is the file truncated?")
    return labelled_matrix(
        entries.rows, entries.columns, entries.values, symmetric=entries.form == _SYMMETRIC
    )


def _take(matrices: dict[str, _Entries], fields: list[str]) -> None:
    name, second = fields[1], int(fields[2])
    if second == 0:
        matrices[name] = _Entries(form=_header(name, fields))
        return
    if name not in matrices:
        raise InputError(f"the matrix {name!r} has no header before this card")
    _take_column(matrices[name], fields)


def _header(name: str, fields: list[str]) -> int:
    form, kind = int(fields[3]), int(fields[4])
    if kind not in _REAL:
        raise InputError(f"matrix {name!r} must be real, not complex", value=f"type {kind}")
    return form


def _take_column(entries: _Entries, fields: list[str]) -> None:
    column = (int(fields[2]), int(fields[3] or 0))
    for start in range(5, len(fields), 4):
        group = fields[start : start + 4]
        if not any(group):
            continue
        entries.rows.append((int(group[0]), int(group[1] or 0)))
        entries.columns.append(column)
        entries.values.append(_real(group[2]))


def _real(text: str) -> float:
    """Return a number as Nastran writes it: ``1.5``, ``1.5E3``, ``1.5D3`` or ``1.5+3``."""
    plain = text.upper().replace("D", "E")
    return float(re.sub(r"(?<=[\d.])([+-]\d+)$", r"E\1", plain))


def _cards(lines: list[str]) -> Iterator[tuple[int, list[str]]]:
    """Yield the DMIG cards: the number of their first line, and their fields.

    The first field is the name of the card and every continuation adds eight (small fields)
    or four (large ones), so that the entries of a column stand at 5, 9, 13, ...
    """
    card: list[str] | None = None
    first = 0
    for number, line in enumerate(lines, start=1):
        text = line.partition("$")[0].rstrip()
        if not text:
            continue
        if text[0] in " +*,":
            if card is not None:
                card += _fields(text)[1:]
            continue
        if card is not None:
            yield first, card
        card, first = None, number
        if re.match(r"DMIG\s*[*,\s]", text.upper()):
            card = _fields(text)
    if card is not None:
        yield first, card


def _fields(line: str) -> list[str]:
    """Return the name field and the data fields of a line, without that of continuation."""
    if "," in line:
        fields = [word.strip() for word in line.split(",")][:9]
        return fields + [""] * (9 - len(fields))
    text = line.expandtabs(8)
    width = 16 if "*" in text[:8] else 8
    count = 64 // width
    data = text[8:72].ljust(64)
    return [text[:8], *(data[width * i : width * (i + 1)].strip() for i in range(count))]
