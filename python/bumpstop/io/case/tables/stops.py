"""``[stops.NAME]``."""

from typing import TYPE_CHECKING, Annotated, Any

from bumpstop.io.case.fields.laws import (
    ContactStiffness,
    FrictionCoefficients,
    Profile,
    Sliding,
)
from bumpstop.io.case.fields.quantities import (
    Angle,
    DampingConstant,
    InverseSpeed,
    Length,
    Length3,
    Number3,
    PositiveLength,
    PositiveNumber,
    Ratio,
    Stiffness,
)
from bumpstop.io.case.fields.words import Node, Nodes, OneDof, choice
from bumpstop.io.case.tables.later import later
from bumpstop.io.case.tables.table import Field, Table

if TYPE_CHECKING:
    from bumpstop.io.case.tables.buckling import BucklingTable
    from bumpstop.io.case.tables.motion import MotionTable
else:
    BucklingTable = later("buckling", "BucklingTable")
    MotionTable = later("motion", "MotionTable")

__all__ = ["StopTable"]


class StopTable(Table):
    """A spring and damper that push a node back once it has crossed the gap; they never pull.

    With ``restitution`` instead of a stiffness the stop is rigid; with an ``exponent``, or
    ``hunt_crossley``, its force is a power of the depth.
    """

    node: Node | None = Field(default=None, description="The node that it stops")
    nodes: Nodes | None = Field(
        default=None,
        description="Instead of node: several nodes, each of which it stops alike; the stop of "
        "node B is called NAME.B",
    )
    obstacle: Annotated[str, choice("plane", "two_planes", "circle", "polar")] = Field(
        default="plane",
        description="Shape of the obstacle: a plane; two that face each other, as the stops NAME+, "
        "which pushes along the normal, and NAME-; a circle, or a polygon r(angle), about an axis",
    )
    normal: Number3 | None = Field(
        default=None, description="Direction in which the obstacle pushes the structure"
    )
    other: Node | None = Field(
        default=None, description="A node that carries the obstacle; else it is fixed"
    )
    axis: Number3 | None = Field(
        default=None, description="Axis of a circle or a polar profile, instead of a normal"
    )
    roll: Angle | None = Field(
        default=None,
        description="Angle about the axis from the part of the y axis across it (of the z axis "
        "where the axis is along y) to the first direction of the obstacle's plane",
    )
    centre: Length3 | None = Field(
        default=None,
        description="Place at rest of a circle's or a profile's centre from the node; the node's "
        "own place where left out, or that of the other node",
    )
    radius: PositiveLength | None = Field(
        default=None, description="Radius of a circle; where left out its gap all around is told"
    )
    body_radius: Length | None = Field(
        default=None, description="Radius of the body at the node, in a circle or beside one"
    )
    side: Annotated[str, choice("inside", "outside")] | None = Field(
        default=None, description="On which side of the circle the node is; inside where left out"
    )
    profile: Profile | None = Field(
        default=None,
        description="Corners [angle, radius] of a polar profile, in rad and m, angles increasing",
    )
    half_thickness: Length | None = Field(
        default=None, description="Of the body at the node, before planes: taken off the gap"
    )
    other_half_thickness: Length | None = Field(
        default=None, description="Of the body that carries the planes: taken off the gap, too"
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
        "has neither stiffness nor damping; with friction the moreau_jean method alone takes it",
    )
    resolution: Ratio | None = Field(
        default=None,
        description="Rebounds from a rigid stop lower than this part of the motion end in rest; "
        "from 1e-13 to 1, 1e-12 where left out",
    )
    damping: DampingConstant = Field(default=0.0, description="Contact damping, in N s/m")
    buckling: BucklingTable | None = Field(
        default=None, description="What it does beyond a critical force; such a stop does not rub"
    )
    motion: MotionTable | None = Field(
        default=None,
        description="How far the obstacle moves over time: a plane along its normal, towards the "
        "structure, others along axes",
    )
    frame: Annotated[str, choice("relative", "absolute")] | None = Field(
        default=None,
        description="Where the obstacle stands while supports move: relative to them, as where "
        "left out, or absolute, still on the ground",
    )
    friction: FrictionCoefficients | None = Field(
        default=None,
        description="Coefficient of Coulomb friction, or { static = ..., dynamic = ... }, and for "
        'results published by steps rule = "velocity_sign"',
    )
    sliding: Sliding | None = Field(
        default=None,
        description="Direction along the obstacle in which it rubs, or weights of dofs as in "
        "terms; not needed where the node moves in one direction only along the obstacle; or "
        '"plane": it rubs in every direction along a plane',
    )
    tangential_stiffness: Stiffness | None = Field(
        default=None, description="Stiffness of a contact that sticks, in N/m; friction needs it"
    )
    tangential_damping: DampingConstant | None = Field(
        default=None,
        description="Damping of a contact that sticks, in N s/m; where left out none with a plane, "
        "and critical damping with obstacles about an axis",
    )

    @classmethod
    def rules(cls) -> dict[str, Any]:
        """Return that a stop has a node and normal or terms, and a stiffness or restitution."""
        node = [{"required": ["node"]}, {"required": ["nodes"]}]
        place = [
            {"required": ["normal"], "oneOf": node},
            {"required": ["axis"], "oneOf": node},
            {"required": ["terms"]},
        ]
        kind = [{"required": ["stiffness"]}, {"required": ["restitution"]}]
        return {"allOf": [{"oneOf": place}, {"oneOf": kind}]}
