"""``[loads.NAME]``: one table a type of load."""

from typing import Annotated, Literal

from bumpstop.io.case.fields.quantities import (
    Acceleration3,
    Force3,
    Length,
    LineForce3,
    Moment3,
)
from bumpstop.io.case.fields.words import BeamName, Node, choice
from bumpstop.io.case.tables.table import Field, Kinds, Table
from bumpstop.io.case.tables.time import TimeKeys

__all__ = ["ForceTable", "GravityTable", "LineForceTable", "LoadTable"]


class ForceTable(TimeKeys):
    """A force on a node, from t = 0 on: constant, or times a function of time."""

    type: Literal["force"] = Field(description="Kind of load")
    node: Node = Field(description="The node it acts on")
    force: Force3 = Field(default=(0.0, 0.0, 0.0), description="Components along X, Y, Z, in N")
    moment: Moment3 = Field(default=(0.0, 0.0, 0.0), description="Components about X, Y, Z, in N m")


class LineForceTable(TimeKeys):
    """A force spread along a beam, uniform or changing linearly."""

    type: Literal["line_force"] = Field(description="Kind of load")
    beam: BeamName = Field(description="The beam it acts on")
    force: LineForce3 = Field(description="Components in N/m")
    end_force: LineForce3 | None = Field(
        default=None,
        description="Components in N/m at the end of the loaded length, where they differ; "
        "between, they change linearly",
    )
    start: Length = Field(default=0.0, description="Where it begins, in m from the first node")
    end: Length | None = Field(
        default=None, description="Where it ends, in m from the first node; at the last one else"
    )
    axes: Annotated[str, choice("global", "local")] = Field(
        default="global", description="Whether components are along X, Y, Z or the beam's own axes"
    )


class GravityTable(Table):
    """Weight: the same acceleration on every mass of the structure."""

    type: Literal["gravity"] = Field(description="Kind of load")
    acceleration: Acceleration3 = Field(description="Components along X, Y, Z, in m/s2")


LoadTable = Annotated[ForceTable | LineForceTable | GravityTable, Kinds("type")]
