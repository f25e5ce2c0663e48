"""``[links.NAME]``."""

from bumpstop.io.case.fields.words import Dofs, LinkedNodes
from bumpstop.io.case.tables.table import Field, Table
from bumpstop.structure.dofs import DOFS

__all__ = ["LinkTable"]


class LinkTable(Table):
    """Nodes that move with a first one as if a rigid body joined them."""

    nodes: LinkedNodes = Field(description="The node that leads, and then those that follow it")
    dofs: Dofs = Field(
        default=list(DOFS),
        description="What of the followers is tied; with some only, they stay free in the others",
    )
