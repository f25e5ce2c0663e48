"""``[[supports]]``."""

from bumpstop.io.case.fields.words import Dofs, Nodes
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["SupportTable"]


class SupportTable(Table):
    """Nodes that are held along or about some axes."""

    nodes: Nodes = Field(description='Names of nodes, or "all", which means those in beams too')
    fixed: Dofs = Field(
        description="What is held: dx dy dz (displacements), drx dry drz (rotations)"
    )
