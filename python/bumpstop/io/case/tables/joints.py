"""``[[joints]]``."""

from bumpstop.io.case.fields.words import BeamEnds, Dofs
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["JointTable"]


class JointTable(Table):
    """Two interface nodes of parts, at one place, that move as one."""

    nodes: BeamEnds = Field(description='The nodes with their parts: `["left.B", "right.A"]`')
    dofs: Dofs | None = Field(
        default=None,
        description="What they share, along and about X, Y, Z; all their dofs where left out",
    )
