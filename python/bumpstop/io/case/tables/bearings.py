"""``[bearings.NAME]``."""

from bumpstop.io.case.fields.constants import PlaneDamping, PlaneStiffness
from bumpstop.io.case.fields.quantities import Number3
from bumpstop.io.case.fields.words import Node
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["BearingTable"]


class BearingTable(Table):
    """A bearing of a rotor: it holds a node in the plane across its axis.

    Stiffness and damping are one number, or a matrix of 2 x 2 of any symmetry in the local y
    and z of a beam along the axis.
    """

    node: Node = Field(description="The node that it holds")
    other: Node | None = Field(
        default=None, description="The node of its housing; the ground where left out"
    )
    axis: Number3 = Field(default=(1.0, 0.0, 0.0), description="Direction of the rotor")
    stiffness: PlaneStiffness = Field(description="In N/m")
    damping: PlaneDamping = Field(default=0.0, description="In N s/m")
