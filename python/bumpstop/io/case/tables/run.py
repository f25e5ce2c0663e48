"""``[run]``."""

from typing import Annotated

from bumpstop.io.case.fields.counts import Switch
from bumpstop.io.case.fields.quantities import PositiveNumber, PositiveTime, Ratio
from bumpstop.io.case.fields.words import Formats, choice
from bumpstop.io.case.tables.table import Field, Table
from bumpstop.simulate import METHODS

__all__ = ["RunTable"]


class RunTable(Table):
    """For how long to simulate, and how."""

    duration: PositiveTime = Field(description="Time to simulate, in s")
    method: Annotated[str, choice(*METHODS)] = Field(
        default="auto", description="How time is integrated"
    )
    dt: PositiveTime | None = Field(
        default=None, description="Step of the fixed-step methods, in s; the others do not use it"
    )
    beyond_stability_limit: Switch = Field(
        default=False, description="Allow a step above the stability limit of a fixed-step method"
    )
    rtol: PositiveNumber | None = Field(
        default=None,
        description="Relative tolerance of the adaptive methods, 1e-8 where left out; the others "
        "do not use it",
    )
    atol: Ratio | None = Field(
        default=None,
        description="Absolute tolerance of the adaptive methods, in m and m/s of the modal motion",
    )
    sample: PositiveTime | None = Field(
        default=None,
        description="Interval of the tabulated results, in s; it does not affect the solution",
    )
    export: Formats = Field(
        default=[], description="Formats in which `--out` writes responses beside NetCDF"
    )
