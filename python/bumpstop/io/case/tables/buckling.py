"""``buckling`` of a stop."""

from bumpstop.io.case.fields.laws import Unloading
from bumpstop.io.case.fields.quantities import DampingConstant, Force, Length
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["BucklingTable"]


class BucklingTable(Table):
    """What a stop does that buckles under a critical force and is crushed beyond it."""

    critical_force: Force = Field(description="Force at which it buckles, in N")
    post_force: Force = Field(description="Force at which it is crushed, in N")
    plateau: Length = Field(default=0.0, description="Crushing at the critical force, in m")
    fall: Length = Field(
        default=0.0, description="Crushing over which the force falls to that after buckling, in m"
    )
    post_damping: DampingConstant = Field(
        default=0.0, description="Contact damping after buckling, in N s/m"
    )
    unloading_stiffness: Unloading | None = Field(
        default=None,
        description="Stiffness with which it unloads, in N/m, or points [residual crushing, "
        "stiffness], in m and N/m; to where contact began where left out",
    )
