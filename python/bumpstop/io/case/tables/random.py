"""Random functions of time: what decides them."""

from typing import Annotated

from bumpstop.io.case.fields.counts import CountFromZero
from bumpstop.io.case.fields.quantities import (
    Frequencies,
    Numbers,
    PositiveTime,
    Ratio,
    WrittenList,
)
from bumpstop.io.case.fields.words import Text, choice
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["AccelerogramTable", "DensityTable", "RandomTable"]


class OverFrequencyTable(Table):
    """Values over frequency: in a file, or here."""

    frequencies: Frequencies | None = Field(default=None, description="In Hz, ascending")
    values: Numbers | None = Field(default=None, description="The value at each of them")
    file: Text | None = Field(
        default=None, description="Instead: a file of columns, relative to the case file"
    )
    columns: WrittenList | None = Field(
        default=None,
        description="Columns of the file that hold frequencies and values, by number from 1 or by "
        "name; the first two where left out",
    )


class DensityTable(OverFrequencyTable):
    """A one-sided power spectral density, zero below and above its frequencies."""

    interpolation: Annotated[str, choice("logarithmic", "linear")] = Field(
        default="logarithmic",
        description="On which axes the density is a straight line between its values",
    )


class RandomTable(Table):
    """A stationary random function: waves of all frequencies with random phases."""

    psd: DensityTable = Field(
        description="Its one-sided density, in the square of what the load is in, per Hz: the "
        "load's force or acceleration says in what unit and direction"
    )
    seed: CountFromZero = Field(description="A whole number that decides the phases")
    period: PositiveTime = Field(
        description="After how long it repeats itself, in s: not less than the run"
    )


class AccelerogramTable(Table):
    """A random acceleration that meets a response spectrum."""

    spectrum: OverFrequencyTable = Field(
        description="Target: pseudo-acceleration of oscillators over their frequency, in what the "
        "load's acceleration is multiplied by; straight lines on logarithmic axes"
    )
    damping: Ratio = Field(description="Ratio of critical damping that the spectrum is for")
    duration: PositiveTime = Field(description="How long it lasts, in s")
    seed: CountFromZero = Field(description="A whole number that decides the phases")
    rise: PositiveTime | None = Field(
        default=None, description="How long it rises, in s; a sixth of the duration else"
    )
    decay: PositiveTime | None = Field(
        default=None, description="How long it decays, in s; a third of the duration else"
    )
