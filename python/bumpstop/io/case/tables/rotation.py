"""``[rotation]``."""

from typing import Annotated

from bumpstop.io.case.fields.quantities import Angle, AngularRate, Numbers
from bumpstop.io.case.fields.words import choice
from bumpstop.io.case.tables.table import Field, Table
from bumpstop.io.case.tables.time import TimeTableTable

__all__ = ["RotationTable"]


class RotationTable(Table):
    """How the shafts turn: at a constant speed, or along a polynomial or a table of speeds."""

    speed: AngularRate | None = Field(default=None, description="Constant speed, in rad/s")
    polynomial: Numbers | None = Field(
        default=None,
        description="Instead of it: coefficients of 1, t, t2, ... of the speed in rad/s, t in s; "
        "of degree 5 at most",
    )
    table: TimeTableTable | None = Field(
        default=None, description="Instead of it: a table of speeds in rad/s, without jumps"
    )
    initial_angle: Angle = Field(default=0.0, description="Angle of the shafts at t = 0, in rad")
    spin: AngularRate = Field(
        default=1.0,
        description="Speed that the gyroscopic matrix belongs to: the spin of beams and masses, "
        "in rad/s",
    )
    acceleration_terms: Annotated[str, choice("lagrange", "fixed_axis", "none")] = Field(
        default="lagrange",
        description="What the angular acceleration multiplies beside the stiffness: half of the "
        "couplings of the gyroscopic matrix, all of them, or none",
    )
