"""``[masses.NAME]``."""

from bumpstop.io.case.fields.constants import Axes2, Inertia
from bumpstop.io.case.fields.quantities import AngularRate, Length3, Mass
from bumpstop.io.case.fields.words import Node
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["MassTable"]


class MassTable(Table):
    """A rigid body on a node; without inertia it resists translation alone."""

    node: Node = Field(description="The node that carries it")
    mass: Mass = Field(description="Mass, in kg; it may be 0 where there is inertia")
    inertia: Inertia | None = Field(
        default=None,
        description="About its centre of mass, in kg m2: xx, yy, zz, also xy, yz, xz, or 3 x 3",
    )
    offset: Length3 = Field(
        default=(0.0, 0.0, 0.0), description="Its centre of mass from the node, in m"
    )
    axes: Axes2 | None = Field(
        default=None,
        description="Its local x, and a vector on the side of local y; global where left out",
    )
    spin: AngularRate = Field(
        default=0.0, description="Constant speed of rotation about its local x, in rad/s"
    )
