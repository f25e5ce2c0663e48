"""Dof maps: which node and dof each row of a matrix belongs to, as a table (.csv).

One line a row of the matrix, in its order; columns ``node`` and ``dof`` (``dx`` to ``drz``, or 1
to 6), and where known ``x``, ``y``, ``z`` (coordinates of the node in m) and ``fixed`` (1 where the
dof is held at zero).
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from bumpstop.arguments import Vector, did_you_mean
from bumpstop.errors import InputError
from bumpstop.files import written_whole
from bumpstop.io.reading import in_file, read_lines
from bumpstop.structure.dofs import DOFS, Dof

__all__ = ["DofMap", "read_dof_map", "write_dof_map"]

_AXES = ("x", "y", "z")
_COLUMNS = ("node", "dof", *_AXES, "fixed")


@dataclass(frozen=True)
class DofMap:
    """What the rows of a matrix are.

    Parameters
    ----------
    dofs
        Node and dof of each row.
    positions
        Coordinates in m of the nodes for which they are known.
    fixed
        Node and dof of what is held at zero.
    """

    dofs: tuple[Dof, ...]
    positions: Mapping[str, Vector] = field(default_factory=dict)
    fixed: tuple[Dof, ...] = ()


def read_dof_map(path: Path) -> DofMap:
    """Read a dof map.

    Raises
    ------
    InputError
        If the file cannot be read, has no column ``node`` or ``dof``, or a line is wrong: an
        unknown dof, one that is there twice, a node in two places.
    """
    with in_file(path):
        lines = [*enumerate(read_lines(path, "a table of dofs"), start=1)]
        written = [(n, line) for n, line in lines if line and not line.startswith("#")]
        if not written:
            raise InputError("is empty, but should be a table of dofs")
        comma = ";" if ";" in written[0][1] else ","
        columns = _header(next(csv.reader([written[0][1]], delimiter=comma)))
        table = _Table(columns)
        for number, line in written[1:]:
            try:
                table.take(next(csv.reader([line], delimiter=comma)))
            except InputError as error:
                raise error.located(key=f"line {number}") from error
        if not table.dofs:
            raise InputError("holds no dof")
        return DofMap(tuple(table.dofs), table.positions, tuple(table.fixed))


def _header(words: list[str]) -> list[str]:
    columns = [word.strip().lower() for word in words]
    for wanted in ("node", "dof"):
        if wanted not in columns:
            hint = "the first line must be like 'node,dof,x,y,z'"
            raise InputError(f"has no column {wanted!r}", value=",".join(columns), hint=hint)
    for column in columns:
        if column not in _COLUMNS:
            hint = did_you_mean(column, _COLUMNS)
            raise InputError("unknown column", value=column, hint=hint)
    return columns


class _Table:
    """The lines that were read so far."""

    def __init__(self, columns: list[str]) -> None:
        self.columns = columns
        self.dofs: dict[Dof, None] = {}
        self.positions: dict[str, Vector] = {}
        self.fixed: list[Dof] = []

    def take(self, words: list[str]) -> None:
        if len(words) != len(self.columns):
            what = f"has {len(words)} fields instead of {len(self.columns)}"
            raise InputError(what, value=",".join(words))
        row = dict(zip(self.columns, (word.strip() for word in words), strict=True))
        dof = (_node(row["node"]), _dof(row["dof"]))
        if dof in self.dofs:
            raise InputError("this dof is there twice", value=".".join(dof))
        self.dofs[dof] = None
        self._take_position(dof[0], [row.get(axis, "") for axis in _AXES])
        if _is_true(row.get("fixed", "")):
            self.fixed.append(dof)

    def _take_position(self, node: str, words: list[str]) -> None:
        if not any(words):
            return
        x, y, z = (_number(axis, word or "0") for axis, word in zip(_AXES, words, strict=True))
        if self.positions.setdefault(node, (x, y, z)) != (x, y, z):
            raise InputError(f"node {node!r} is at another place than before", value=(x, y, z))


def _node(word: str) -> str:
    if not word:
        raise InputError("a node must have a name")
    return word


def _dof(word: str) -> str:
    if word in ("1", "2", "3", "4", "5", "6"):
        return DOFS[int(word) - 1]
    if word.lower() not in DOFS:
        raise InputError("unknown dof", value=word, hint=did_you_mean(word, DOFS))
    return word.lower()


def _number(axis: str, word: str) -> float:
    try:
        number = float(word)
    except ValueError:
        number = float("nan")
    if not abs(number) < float("inf"):
        raise InputError(f"{axis} must be a number", value=word)
    return number


def _is_true(word: str) -> bool:
    if word not in ("", "0", "1"):
        raise InputError("fixed must be 1 or 0", value=word)
    return word == "1"


def write_dof_map(path: Path, dof_map: DofMap) -> None:
    """Write a dof map, with coordinates where they are known.

    Raises
    ------
    InputError
        If nothing can be written there.
    """
    fixed = set(dof_map.fixed)
    with written_whole(path) as part, part.open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(_COLUMNS)
        for node, dof in dof_map.dofs:
            place = dof_map.positions.get(node, ("", "", ""))
            table.writerow([node, dof, *place, int((node, dof) in fixed)])
