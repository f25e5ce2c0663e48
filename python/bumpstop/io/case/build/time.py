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
    from bumpstop.io.case.tables.time import FactorTable, TimeKeys, TimeTableTable
    from bumpstop.loads.time import TimeFunction

__all__ = ["built_table", "built_time"]

_OF_FILES = ("columns", "step", "units")
"""What is said of a file of times and values."""


def built_time(table: TimeKeys, folder: Path) -> list[TimeFunction] | None:
    """Return the functions whose sum the table means; None for a constant."""
    tolerance = table.line_tolerance
    functions = _sum(table, folder, tolerance)
    if table.product is not None:
        factors = []
        for number, factor in enumerate(table.product):
            with keyed(f"product.{number}"):
                factors.append(_sum(factor, folder, tolerance))
                if not factors[-1]:
                    raise InputError("has no function of time", hint="such as harmonics or a table")
        with keyed(renamed={"factors": "product", "tolerance": "line_tolerance"}):
            functions.append(loads.Product(factors, tolerance=tolerance))
    return functions or None


def _sum(table: FactorTable, folder: Path, tolerance: float) -> list[TimeFunction]:
    """Return the functions that the keys of a table mean, but for products."""
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
            functions.append(built_table(table.table, folder))
    for number, sweep in enumerate(table.sweeps):
        with keyed(f"sweeps.{number}"):
            functions.append(loads.Sweep(**dict(sweep), tolerance=tolerance))
    for key in ("random", "accelerogram"):
        if getattr(table, key) is not None:
            from bumpstop.io.case.build import random

            with keyed(key):
                functions.append(getattr(random, f"built_{key}")(getattr(table, key), folder))
    if table.expression is not None:
        with keyed(renamed={"formula": "expression", "tolerance": "line_tolerance"}):
            functions.append(loads.Expression(table.expression, tolerance=tolerance))
    return functions


def built_table(table: TimeTableTable, folder: Path) -> loads.TimeTable:
    """Return the straight lines that a table of values describes."""
    if table.file is None:
        for key in _OF_FILES:
            if getattr(table, key) is not None:
                raise InputError("is for a file", key=key, hint="give file, or leave it out")
        if table.times is None or table.values is None:
            raise InputError("needs a file, or times and values", hint='file = "pulse.csv"')
        times, values = np.array(table.times), np.array(table.values)
    else:
        for key in ("times", "values"):
            if getattr(table, key) is not None:
                raise InputError("is in the file", key=key, hint="give either one")
        times, values = read_time_table(
            folder / table.file,
            columns=table.columns,
            step=table.step,
            units=table.units,
            skip=table.skip,
        )
    return loads.TimeTable(times, table.scale * values, beyond=table.beyond)
