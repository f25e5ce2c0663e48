"""How loads change in time: keys that their tables share."""

from typing import Annotated

from bumpstop.io.case.fields.quantities import (
    Frequency,
    Number,
    Numbers,
    PositiveTime,
    Times,
    WrittenList,
)
from bumpstop.io.case.fields.words import Text, choice
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["HarmonicTable", "TimeKeys", "TimeTableTable"]


class HarmonicTable(Table):
    """An oscillation, cosine cos(2 pi f t) + sine sin(2 pi f t)."""

    frequency: Frequency = Field(description="Its frequency f, in Hz")
    cosine: Number = Field(default=0.0, description="Amplitude of the cosine")
    sine: Number = Field(default=0.0, description="Amplitude of the sine")


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


class TimeKeys(Table):
    """What a load is multiplied by: the sum of all that is given, or one."""

    harmonics: list[HarmonicTable] = Field(default=[], description="Oscillations")
    polynomial: Numbers | None = Field(
        default=None,
        description="Coefficients of 1, t, t2, ... with t in s from the start of the run; of "
        "degree 5 at most",
    )
    table: TimeTableTable | None = Field(default=None, description="A table of values over time")
