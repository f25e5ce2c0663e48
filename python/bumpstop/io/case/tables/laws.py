"""``[laws.NAME]``: one table a type of law."""

from typing import Annotated, Literal

from bumpstop.io.case.fields.laws import (
    CrackPoints,
    Curve,
    DampingSlopes,
    Deformations,
    Slopes,
    SpeedCurve,
    Speeds,
)
from bumpstop.io.case.fields.quantities import (
    DampingConstant,
    Directions,
    Force,
    Length,
    Number,
    Number3,
    PositiveLength,
    PositiveNumber,
    Stiffness,
)
from bumpstop.io.case.fields.words import Command, Node, OneDof, Text, choice
from bumpstop.io.case.tables.table import Field, Kinds, Table

__all__ = [
    "CrackedRotorTable",
    "DamperLawTable",
    "ForceRelationTable",
    "HardeningSpringTable",
    "LawTable",
    "OutsideProgramTable",
    "SeismicDeviceTable",
    "SpringLawTable",
    "UserLawTable",
    "ZenerDamperTable",
]


class ConnectionTable(Table):
    """What laws that hold a node have."""

    node: Node | None = Field(default=None, description="The node that it holds")
    direction: Number3 | None = Field(
        default=None, description="Direction in which its deformation is measured"
    )
    other: Node | None = Field(
        default=None, description="The node that holds it; the ground where left out"
    )
    terms: dict[Node, dict[OneDof, Length]] | None = Field(
        default=None,
        description="Instead of node, direction and other: weights of dofs in the deformation; "
        "that of a rotation is a length, in m",
    )


class SpringLawTable(ConnectionTable):
    """An elastic spring whose stiffness changes with its deformation, with a damper beside it."""

    type: Literal["spring"] = Field(description="Kind of law")
    stiffness: Slopes | None = Field(
        default=None,
        description="Slope of the force in each segment, in N/m, one more than breaks; zero for "
        "play, negative for buckling",
    )
    breaks: Deformations | None = Field(
        default=None, description="Deformations at which the slope changes, increasing, in m"
    )
    preload: Force | None = Field(
        default=None, description="Force that resists at no deformation, in N"
    )
    curve: Curve | None = Field(
        default=None,
        description="Instead of stiffness, breaks and preload: points [deformation, force] that "
        "the force runs through, in m and N",
    )
    damping: DampingConstant = Field(default=0.0, description="Damping constant, in N s/m")


class ZenerDamperTable(ConnectionTable):
    """A viscous damper with springs: one in series with a spring beside a spring and a dashpot."""

    type: Literal["zener"] = Field(description="Kind of law")
    series_stiffness: Stiffness = Field(
        description="Stiffness of the spring in series with all else, in N/m"
    )
    parallel_stiffness: Stiffness | None = Field(
        default=None,
        description="Stiffness of the spring beside the dashpot and its spring, in N/m",
    )
    branch_stiffness: Stiffness = Field(
        description="Stiffness of the spring in series with the dashpot, in N/m"
    )
    damping: PositiveNumber = Field(description="Force of the dashpot at 1 m/s, in N")
    exponent: PositiveNumber = Field(
        default=1.0, description="Power of the speed that its force goes with, at most 1"
    )


class DamperLawTable(ConnectionTable):
    """A damper whose constant changes with its speed: a force that is a table of the speed."""

    type: Literal["damper"] = Field(description="Kind of law")
    damping: DampingSlopes | None = Field(
        default=None,
        description="Slope of the force in each segment, in N s/m, one more than breaks",
    )
    breaks: Speeds | None = Field(
        default=None, description="Speeds at which the slope changes, increasing, in m/s"
    )
    offset: Force | None = Field(default=None, description="Force that resists at no speed, in N")
    curve: SpeedCurve | None = Field(
        default=None,
        description="Instead of damping, breaks and offset: points [speed, force] that the force "
        "runs through, in m/s and N",
    )


class ForceRelationTable(ConnectionTable):
    """A force that is a formula of the displacement x and the velocity v along a direction."""

    type: Literal["relation"] = Field(description="Kind of law")
    force: Text = Field(
        description="Force on the node, in N, as a formula of x in m and v in m/s: a spring is "
        '"-2e4 * x"'
    )


class SeismicDeviceTable(ConnectionTable):
    """A spring that softens beyond a threshold, with a damper by a power of the speed."""

    type: Literal["seismic"] = Field(description="Kind of law")
    first_stiffness: Stiffness = Field(description="Stiffness at small elongations, in N/m")
    second_stiffness: Stiffness = Field(
        description="Stiffness at large elongations, in N/m, not above the first"
    )
    threshold: Force = Field(description="Force around which the stiffness changes, in N")
    damping: Force | None = Field(
        default=None,
        description="Force of the damper where speed times elongation over stroke is 1 m/s, in N",
    )
    exponent: PositiveNumber = Field(
        default=1.0, description="Power of the damper, at most 1, which is that of a linear one"
    )
    stroke: PositiveLength | None = Field(
        default=None, description="Elongation that the damper's is measured by, in m"
    )
    rest_speed: PositiveNumber | None = Field(
        default=None, description="Speed below which the damper is linear, in m/s; 1e-6 if left out"
    )


class HardeningSpringTable(ConnectionTable):
    """A spring that yields, and hardens as it does, along a table of force against elongation."""

    type: Literal["hardening"] = Field(description="Kind of law")
    curve: Curve = Field(
        description="Points [elongation, force] of a first pull, in m and N, from the elastic limit"
    )
    hardening: Annotated[str, choice("isotropic", "kinematic")] = Field(
        default="isotropic",
        description="Whether its limit grows both ways or is shifted, for which the curve has two "
        "points",
    )


class CrackedRotorTable(Table):
    """A crack across a shaft that turns as ``[rotation]`` says."""

    type: Literal["cracked_rotor"] = Field(description="Kind of law")
    node: Node = Field(description="The node on one side of the crack")
    other: Node | None = Field(
        default=None, description="The node on its other side; the ground where left out"
    )
    axis: Number3 = Field(default=(1.0, 0.0, 0.0), description="Direction of the shaft")
    stiffness: Text | None = Field(
        default=None,
        description="Bending stiffness in N m/rad as a formula in phi, the direction of the "
        'bending in the shaft, in rad: "2e6 + 1e6 * sin(phi)"',
    )
    derivative: Text | None = Field(
        default=None,
        description="Its derivative, in N m/rad2, as a formula; that of the stiffness where left "
        "out",
    )
    points: CrackPoints | None = Field(
        default=None,
        description="Instead of a formula: points [phi, stiffness], or [phi, stiffness, "
        "derivative], around one turn",
    )
    file: Text | None = Field(
        default=None,
        description="Instead of a formula: a file of these points, relative to the case file; "
        "columns parted by commas or blanks, remarks behind #",
    )
    interpolation: Annotated[str, choice("spline", "linear")] = Field(
        default="spline",
        description="How it goes between points: by a periodic cubic spline, or by straight lines, "
        "which need the derivative",
    )


class ProgrammedTable(ConnectionTable):
    """What laws have that a program computes."""

    further_directions: Directions = Field(
        default=(), description="More directions along which it acts, between the same nodes"
    )


class UserLawTable(ProgrammedTable):
    """A force that a function in a Python file computes."""

    type: Literal["python"] = Field(description="Kind of law")
    file: Text = Field(
        description="Python file, relative to the case file, that defines force(q, v, t) and may "
        "define jacobian(q, v, t) and memory_rate(q, v, t, z); it is run as the case is read"
    )
    memory: Number = Field(
        default=0.0, description="Value at t = 0 of the variable whose rate the file gives"
    )


class OutsideProgramTable(ProgrammedTable):
    """A force that another program answers with, once a step of symplectic_euler."""

    type: Literal["program"] = Field(description="Kind of law")
    command: Command = Field(
        description="The program and its arguments; it is started in the folder of the case file, "
        "reads a line with step, displacements and velocities, and writes one with forces"
    )


LawTable = Annotated[
    SpringLawTable
    | ZenerDamperTable
    | DamperLawTable
    | ForceRelationTable
    | SeismicDeviceTable
    | HardeningSpringTable
    | CrackedRotorTable
    | UserLawTable
    | OutsideProgramTable,
    Kinds("type"),
]
