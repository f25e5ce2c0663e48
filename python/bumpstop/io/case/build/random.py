"""Random functions of time, and turbulence."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from bumpstop import loads
from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.io.case.keys import keyed
from bumpstop.io.time_table import read_time_table

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bumpstop.io.case.tables.loads import TurbulenceTable
    from bumpstop.io.case.tables.random import AccelerogramTable, OverFrequencyTable, RandomTable

__all__ = ["built_accelerogram", "built_random", "built_turbulence"]


def built_random(table: RandomTable, folder: Path) -> loads.RandomSignal:
    """Return the random function that a table means."""
    with keyed("psd"):
        frequencies, values = _over_frequency(table.psd, folder)
        psd = loads.SpectralDensity(frequencies, values, interpolation=table.psd.interpolation)
    return loads.RandomSignal(psd, seed=table.seed, period=table.period)


def built_accelerogram(table: AccelerogramTable, folder: Path) -> loads.Accelerogram:
    """Return the accelerogram that a table means."""
    with keyed("spectrum"):
        frequencies, values = _over_frequency(table.spectrum, folder)
    said = {key: value for key, value in table if key != "spectrum"}
    with keyed(renamed={"frequencies": "spectrum.frequencies", "values": "spectrum.values"}):
        return loads.Accelerogram(frequencies, values, **said)


def built_turbulence(name: str, table: TurbulenceTable, folder: Path) -> loads.Turbulence:
    """Return the turbulence that a table means."""
    with keyed("psd"):
        frequencies, values = _over_frequency(table.psd, folder)
        psd = loads.SpectralDensity(frequencies, values, interpolation=table.psd.interpolation)
    said = {key: value for key, value in table if key not in ("type", "psd")}
    return loads.Turbulence(name, density=psd, **said)


def _over_frequency(
    table: OverFrequencyTable, folder: Path
) -> tuple[Sequence[float] | FloatArray, Sequence[float] | FloatArray]:
    if table.file is None:
        if table.columns is not None:
            raise InputError("is for a file", key="columns", hint="give file, or leave it out")
        if table.frequencies is None or table.values is None:
            hint = "frequencies = [10, 100], values = [0.1, 0.1]"
            raise InputError("needs a file, or frequencies and values", hint=hint)
        return table.frequencies, table.values
    for key in ("frequencies", "values"):
        if getattr(table, key) is not None:
            raise InputError("is in the file", key=key, hint="give either one")
    return read_time_table(folder / table.file, columns=table.columns)
