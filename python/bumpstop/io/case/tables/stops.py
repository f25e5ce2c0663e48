"""``[stops.NAME]``."""

from typing import TYPE_CHECKING, Annotated, Any

from bumpstop.io.case.fields.laws import ContactStiffness, FrictionCoefficients, Sliding
from bumpstop.io.case.fields.quantities import (
    DampingConstant,
    InverseSpeed,
    Length,
    Number3,
    PositiveNumber,
    Ratio,
    Stiffness,
)
from bumpstop.io.case.fields.words import Node, OneDof, choice
from bumpstop.io.case.tables.later import later
from bumpstop.io.case.tables.table import Field, Table

if TYPE_CHECKING:
    from bumpstop.io.case.tables.motion import MotionTable
else:
    MotionTable = later("motion", "MotionTable")

__all__ = ["StopTable"]


class StopTable(Table):
    """A spring and damper that push a node back once it has crossed the gap; they never pull.

    With ``restitution`` instead of a stiffness the stop is rigid; with an ``exponent``, or
    ``hunt_crossley``, its force is a power of the depth.
    """

    node: Node | None = Field(default=None, description="The node that it stops")
    obstacle: Annotated[str, choice("plane")] = Field(
        default="plane", description="Shape of the obstacle"
    )
    normal: Number3 | None = Field(
        default=None, description="Direction in which the obstacle pushes the structure"
    )
    other: Node | None = Field(
        default=None, description="A node that carries the obstacle; else it is fixed"
    )
    terms: dict[Node, dict[OneDof, Length]] | None = Field(
        default=None,
        description="Instead of node, normal and other: weights of dofs in the distance, such as "
        "{ pinion.drz = 0.05, wheel.drz = 0.08 }; that of a rotation is a length, in m",
    )
    gap: Length = Field(
        default=0.0, description="Distance from the undeformed structure to the obstacle, in m"
    )
    stiffness: ContactStiffness | None = Field(
        default=None,
        description="Contact stiffness, in N/m; every stop that is not rigid needs it. With an "
        "exponent n a number in N/m^n: the force at a depth of 1 m",
    )
    exponent: PositiveNumber | None = Field(
        default=None,
        description="Power of the depth that the force goes with, at least 1; 1.5 for bodies that "
        "touch in a point (Hertz). Such a stop has neither damping nor friction",
    )
    hunt_crossley: InverseSpeed | None = Field(
        default=None,
        description="Damping coefficient of Hunt and Crossley, in s/m, by which the rate of the "
        "depth multiplies the force; the exponent is 1.5 where left out",
    )
    restitution: Ratio | None = Field(
        default=None,
        description="Part of the speed that a rigid stop gives back, from 0 to 1; such a stop "
        "has neither stiffness nor damping nor friction",
    )
    resolution: Ratio | None = Field(
        default=None,
        description="Rebounds from a rigid stop lower than this part of the motion end in rest; "
        "from 1e-13 to 1, 1e-12 where left out",
    )
    damping: DampingConstant = Field(default=0.0, description="Contact damping, in N s/m")
    motion: MotionTable | None = Field(
        default=None,
        description="How far the obstacle moves along its normal, towards the structure, over time",
    )
    frame: Annotated[str, choice("relative", "absolute")] | None = Field(
        default=None,
        description="Where the obstacle stands while supports move: relative to them, as where "
        "left out, or absolute, still on the ground",
    )
    friction: FrictionCoefficients | None = Field(
        default=None,
        description="Coefficient of Coulomb friction, or { static = ..., dynamic = ... }",
    )
    sliding: Sliding | None = Field(
        default=None,
        description="Direction along the obstacle in which it rubs, or weights of dofs as in "
        "terms; not needed where the node moves in one direction only along the obstacle",
    )
    tangential_stiffness: Stiffness | None = Field(
        default=None, description="Stiffness of a contact that sticks, in N/m; friction needs it"
    )
    tangential_damping: DampingConstant = Field(
        default=0.0, description="Damping of a contact that sticks, in N s/m"
    )

    @classmethod
    def rules(cls) -> dict[str, Any]:
        """Return that a stop has a node and normal or terms, and a stiffness or restitution."""
        place = [{"required": ["node", "normal"]}, {"required": ["terms"]}]
        kind = [{"required": ["stiffness"]}, {"required": ["restitution"]}]
        return {"allOf": [{"oneOf": place}, {"oneOf": kind}]}
