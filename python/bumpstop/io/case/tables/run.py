"""``[run]``."""

from typing import Annotated

from bumpstop.io.case.fields.counts import Switch
from bumpstop.io.case.fields.quantities import Number, PositiveNumber, PositiveTime, Ratio
from bumpstop.io.case.fields.words import Formats, choice
from bumpstop.io.case.tables.table import Field, Table
from bumpstop.methods import METHODS

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
    beta: Ratio | None = Field(
        default=None, description="Newmark's weight in the displacement, 1/4 where left out"
    )
    gamma: Ratio | None = Field(
        default=None, description="Newmark's weight in the velocity, 1/2 where left out"
    )
    alpha: Number | None = Field(
        default=None, description="Parameter of the hht method, -1/3 to 0, -0.05 where left out"
    )
    spectral_radius: Ratio | None = Field(
        default=None,
        description="What a step of the generalized_alpha method leaves of the highest "
        "frequencies, 0 to 1, 0.8 where left out",
    )
    theta: Ratio | None = Field(
        default=None,
        description="Weight of the end of a step in the moreau_jean method, 1/2 to 1, 1/2 where "
        "left out",
    )
    points_per_period: PositiveNumber | None = Field(
        default=None,
        description="Steps of the adaptive_central_difference method in a period of the fastest "
        "visible motion, 10 to 1e7, 50 where left out",
    )
    rtol: PositiveNumber | None = Field(
        default=None,
        description="Relative tolerance of the Runge-Kutta pairs, 1e-8 where left out; the others "
        "do not use it",
    )
    atol: Ratio | None = Field(
        default=None,
        description="Absolute tolerance of the Runge-Kutta pairs, in m and m/s of the modal motion",
    )
    exact_flights: Switch | None = Field(
        default=None,
        description="Whether methods with a tolerance leave flights between contacts to the exact "
        "one, true where left out; the others do not use it",
    )
    sample: PositiveTime | None = Field(
        default=None,
        description="Interval of the tabulated results, in s; it does not affect the solution",
    )
    export: Formats = Field(
        default=[], description="Formats in which `--out` writes responses beside NetCDF"
    )
