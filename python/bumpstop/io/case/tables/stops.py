"""``[stops.NAME]``."""

from typing import Annotated

from bumpstop.io.case.fields.quantities import DampingConstant, Length, Number3, Stiffness
from bumpstop.io.case.fields.words import Node, choice
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["StopTable"]


class StopTable(Table):
    """A spring and damper that push a node back once it has crossed the gap; they never pull."""

    node: Node = Field(description="The node that it stops")
    obstacle: Annotated[str, choice("plane")] = Field(
        default="plane", description="Shape of the obstacle"
    )
    normal: Number3 = Field(description="Direction in which the obstacle pushes the structure")
    gap: Length = Field(
        default=0.0, description="Distance from the undeformed structure to the obstacle, in m"
    )
    stiffness: Stiffness = Field(description="Contact stiffness, in N/m")
    damping: DampingConstant = Field(default=0.0, description="Contact damping, in N s/m")
