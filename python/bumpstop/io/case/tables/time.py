"""How loads change in time: keys that their tables share."""

from typing import TYPE_CHECKING, Annotated

from bumpstop.io.case.fields.counts import CountFromZero
from bumpstop.io.case.fields.quantities import (
    Angle,
    Frequency,
    Frequency2,
    Number,
    Numbers,
    PositiveNumber,
    PositiveTime,
    Time,
    Times,
    WrittenList,
)
from bumpstop.io.case.fields.words import Text, Units, choice
from bumpstop.io.case.tables.later import later
from bumpstop.io.case.tables.table import Field, Table

if TYPE_CHECKING:
    from bumpstop.io.case.tables.random import AccelerogramTable, RandomTable
else:
    AccelerogramTable = later("random", "AccelerogramTable")
    RandomTable = later("random", "RandomTable")

__all__ = ["FactorTable", "HarmonicTable", "SweepTable", "TimeKeys", "TimeTableTable"]


class HarmonicTable(Table):
    """An oscillation, cosine cos(2 pi f t) + sine sin(2 pi f t)."""

    frequency: Frequency = Field(description="Its frequency f, in Hz")
    cosine: Number = Field(default=0.0, description="Amplitude of the cosine")
    sine: Number = Field(default=0.0, description="Amplitude of the sine")


class SweepTable(Table):
    """A sine whose frequency rises or falls; zero before it begins and after it ends."""

    frequencies: Frequency2 = Field(description="At its begin and at its end, in Hz")
    duration: PositiveTime = Field(description="How long it takes, in s")
    spacing: Annotated[str, choice("linear", "logarithmic")] = Field(
        default="linear",
        description="Whether the frequency goes in proportion to time, or by octaves",
    )
    amplitude: Number = Field(default=1.0, description="Its amplitude")
    phase: Angle = Field(default=0.0, description="Where in its period it begins, in rad")
    start: Time = Field(default=0.0, description="When it begins, in s from the start of the run")


class TimeTableTable(Table):
    """Straight lines between given values: in a file, or as times and values here."""

    file: Text | None = Field(
        default=None, description="File of columns, relative to the case file: .csv or any text"
    )
    columns: WrittenList | None = Field(
        default=None,
        description="Columns of the file that hold times and values, by number from 1 or by "
        "their names in its first line; the first two where left out",
    )
    units: Units | None = Field(
        default=None,
        description='Units of the times and values of the file, such as ["ms", "kN"]; SI where '
        "left out",
    )
    skip: CountFromZero = Field(
        default=0, description="How many lines at the head of the file are passed over"
    )
    step: PositiveTime | None = Field(
        default=None,
        description="Time between the values of the file, in s, where it holds no times: its "
        "numbers are then taken line by line",
    )
    times: Times | None = Field(default=None, description="Instead of a file: times, in s")
    values: Numbers | None = Field(default=None, description="The value at each of the times")
    scale: Number = Field(default=1.0, description="What the values are multiplied by")
    beyond: Annotated[str, choice("zero", "hold")] | None = Field(
        default=None,
        description="What it is before its first time and after its last: zero, or hold for the "
        "nearest value; where left out it must cover the whole run",
    )


class FactorTable(Table):
    """A function of time: the sum of all that is given."""

    harmonics: list[HarmonicTable] = Field(default=[], description="Oscillations")
    polynomial: Numbers | None = Field(
        default=None,
        description="Coefficients of 1, t, t2, ... with t in s from the start of the run; of "
        "degree 5 at most",
    )
    table: TimeTableTable | None = Field(default=None, description="A table of values over time")
    sweeps: list[SweepTable] = Field(default=[], description="Sines whose frequency rises or falls")
    random: RandomTable | None = Field(
        default=None, description="A stationary random function with a spectral density"
    )
    accelerogram: AccelerogramTable | None = Field(
        default=None, description="A random acceleration that meets a response spectrum"
    )
    expression: Text | None = Field(
        default=None,
        description='A formula in the time t in s, such as "exp(-3 * t) * sin(20 * t)": numbers, '
        "+ - * / **, pi, e, sin cos tan asin acos atan atan2 sinh cosh tanh exp log sqrt abs min "
        "max, and step(x), which is 1 from x = 0 on",
    )


class TimeKeys(FactorTable):
    """What a load is multiplied by: the sum of all that is given, or one."""

    product: list[FactorTable] | None = Field(
        default=None, description="Functions of time whose product is added to the sum"
    )
    line_tolerance: PositiveNumber = Field(
        default=1e-4,
        description="How far straight lines may stray from sweeps, expressions and products that "
        "need them, relative to the largest value",
    )
