"""Functions of time that loads are multiplied by."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from bumpstop import loads
from bumpstop.errors import InputError
from bumpstop.io.case.keys import keyed
from bumpstop.io.time_table import read_time_table

if TYPE_CHECKING:
    from bumpstop.io.case.tables.time import TimeKeys, TimeTableTable
    from bumpstop.loads.time import TimeFunction

__all__ = ["built_time"]


def built_time(table: TimeKeys, folder: Path) -> list[TimeFunction] | None:
    """Return the functions whose sum the table means; None for a constant."""
    functions: list[TimeFunction] = []
    for number, harmonic in enumerate(table.harmonics):
        with keyed(f"harmonics.{number}"):
            made = loads.Harmonic(harmonic.frequency, cosine=harmonic.cosine, sine=harmonic.sine)
            functions.append(made)
    if table.polynomial is not None:
        with keyed(renamed={"coefficients": "polynomial"}):
            functions.append(loads.Polynomial(table.polynomial))
    if table.table is not None:
        with keyed("table"):
            functions.append(_time_table(table.table, folder))
    return functions or None


def _time_table(table: TimeTableTable, folder: Path) -> loads.TimeTable:
    if table.file is None:
        for key in ("columns", "step"):
            if getattr(table, key) is not None:
                raise InputError("is for a file", key=key, hint="give file, or leave it out")
        if table.times is None or table.values is None:
            raise InputError("needs a file, or times and values", hint='file = "pulse.csv"')
        times, values = np.array(table.times), np.array(table.values)
    else:
        for key in ("times", "values"):
            if getattr(table, key) is not None:
                raise InputError("is in the file", key=key, hint="give either one")
        times, values = read_time_table(folder / table.file, columns=table.columns, step=table.step)
    return loads.TimeTable(times, table.scale * values, beyond=table.beyond)
