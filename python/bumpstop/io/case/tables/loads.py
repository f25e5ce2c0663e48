"""``[loads.NAME]``: one table a type of load."""

from typing import Annotated, Literal

from bumpstop.io.case.fields.quantities import Acceleration3, Force3, Moment3
from bumpstop.io.case.fields.words import Node
from bumpstop.io.case.tables.table import Field, Kinds, Table
from bumpstop.io.case.tables.time import TimeKeys

__all__ = ["ForceTable", "GravityTable", "LoadTable"]


class ForceTable(TimeKeys):
    """A force on a node, from t = 0 on: constant, or times a function of time."""

    type: Literal["force"] = Field(description="Kind of load")
    node: Node = Field(description="The node it acts on")
    force: Force3 = Field(default=(0.0, 0.0, 0.0), description="Components along X, Y, Z, in N")
    moment: Moment3 = Field(default=(0.0, 0.0, 0.0), description="Components about X, Y, Z, in N m")


class GravityTable(Table):
    """Weight: the same acceleration on every mass of the structure."""

    type: Literal["gravity"] = Field(description="Kind of load")
    acceleration: Acceleration3 = Field(description="Components along X, Y, Z, in m/s2")


LoadTable = Annotated[ForceTable | GravityTable, Kinds("type")]
