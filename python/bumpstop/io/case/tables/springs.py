"""``[springs.NAME]``."""

from bumpstop.io.case.fields.constants import Axes2, SpringDamping, SpringStiffness
from bumpstop.io.case.fields.words import Node
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["SpringTable"]


class SpringTable(Table):
    """A spring and damper that holds a node, or joins two.

    Stiffness and damping are one number, along the line between the nodes or along local x;
    six, along and about the local axes; or a symmetric matrix of 6 x 6 (12 x 12 for the dofs of
    both nodes).
    """

    node: Node = Field(description="The node that it holds")
    other: Node | None = Field(
        default=None, description="The node that holds it; the ground where left out"
    )
    stiffness: SpringStiffness | None = Field(default=None, description="In N/m, N and N m")
    damping: SpringDamping | None = Field(default=None, description="In N s/m, N s and N m s")
    axes: Axes2 | None = Field(
        default=None,
        description="Local x, and a vector on the side of local y; the global axes where left out",
    )
