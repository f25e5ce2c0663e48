"""``[parts.NAME]``."""

from bumpstop.io.case.fields.quantities import Angle, Length3, Number3
from bumpstop.io.case.fields.words import Name
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["PartTable", "RotationTable"]


class RotationTable(Table):
    """A turn about the origin of the component's axes, right-handed."""

    axis: Number3 = Field(description="Direction of the axis")
    angle: Angle = Field(description="Angle, in rad")


class PartTable(Table):
    """A component in its place; its nodes are then called ``"NAME.node"``."""

    component: Name = Field(description="Name of one of the [components]")
    at: Length3 = Field(
        default=(0.0, 0.0, 0.0), description="Where the origin of the component goes, in m"
    )
    rotation: RotationTable | None = Field(
        default=None, description="How it is turned before it is moved"
    )
