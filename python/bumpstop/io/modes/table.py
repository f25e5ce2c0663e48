"""Modes as a table (.csv): one line a mode.

Columns: ``frequency`` in Hz, ``damping`` (ratio of critical damping; 0 where left out),
``modal_mass`` in kg (1 where left out), and the shape as one column for each point and dof, such
as ``P.dx``.
"""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from bumpstop.arguments import did_you_mean
from bumpstop.errors import InputError
from bumpstop.io.modes.mode_set import ModeSet
from bumpstop.io.reading import in_file, read_lines
from bumpstop.structure.dofs import DOFS, Dof

__all__ = ["read_mode_table"]

_NUMBERS = ("frequency", "damping", "modal_mass")


def read_mode_table(path: Path) -> ModeSet:
    """Read modes from a table.

    Raises
    ------
    InputError
        If the file cannot be read, has no frequencies or no shapes, or a line is wrong.
    """
    with in_file(path):
        lines = [*enumerate(read_lines(path, "a table of modes"), start=1)]
        written = [(n, line) for n, line in lines if line and not line.startswith("#")]
        comma = ";" if written and ";" in written[0][1] else ","
        rows = [(n, next(csv.reader([line], delimiter=comma))) for n, line in written]
        if len(rows) < 2:
            raise InputError("holds no mode", hint="a first line of names, then a line a mode")
        columns = [word.strip() for word in rows[0][1]]
        dofs = _dofs(columns)
        table = np.array([_numbers(number, words, columns) for number, words in rows[1:]])
        given = {name: table[:, columns.index(name)] for name in _NUMBERS if name in columns}
        return ModeSet(
            frequency=given["frequency"],
            damping=given.get("damping", np.zeros(len(table))),
            modal_mass=given.get("modal_mass", np.ones(len(table))),
            dofs=tuple(dofs.values()),
            shapes=table[:, list(dofs)].T,
        )


def _dofs(columns: list[str]) -> dict[int, Dof]:
    """Return the node and dof of the columns that are shapes."""
    if "frequency" not in columns:
        hint = "the first line must be like 'frequency,damping,P.dx,P.dy'"
        raise InputError("has no column 'frequency'", value=",".join(columns), hint=hint)
    dofs: dict[int, Dof] = {}
    for number, name in enumerate(columns):
        if columns.index(name) != number:
            raise InputError("this column is there twice", value=name)
        if name not in _NUMBERS:
            dofs[number] = _dof(name)
    if not dofs:
        raise InputError("has no shapes", hint="name their columns like 'P.dx'")
    return dofs


def _dof(name: str) -> Dof:
    node, point, dof = name.rpartition(".")
    if not point or not node or dof not in DOFS:
        known = [*_NUMBERS, *(f"{node or 'P'}.{dof}" for dof in DOFS)]
        raise InputError("unknown column", value=name, hint=did_you_mean(name, known))
    return node, dof


def _numbers(number: int, words: list[str], columns: list[str]) -> list[float]:
    if len(words) != len(columns):
        what = f"has {len(words)} fields instead of {len(columns)}"
        raise InputError(what, key=f"line {number}", hint="is the file truncated?")
    return [_number(number, *pair) for pair in zip(columns, words, strict=True)]


def _number(line: int, column: str, word: str) -> float:
    try:
        number = float(word)
    except ValueError:
        number = float("nan")
    if not abs(number) < float("inf"):
        raise InputError(f"{column} must be a number", key=f"line {line}", value=word)
    return number
