"""``[loads.NAME]``: one table a type of load."""

from typing import TYPE_CHECKING, Annotated, Literal

from bumpstop.io.case.fields.counts import Count, CountFromZero
from bumpstop.io.case.fields.quantities import (
    Acceleration3,
    Angle,
    Force3,
    Length,
    LineForce3,
    Mass,
    Moment3,
    Number3,
    PositiveLength,
    PositiveNumber,
    PositiveTime,
    Time,
    Velocity,
)
from bumpstop.io.case.fields.words import BeamName, Node, choice
from bumpstop.io.case.tables.base_motion import SupportMotionTable
from bumpstop.io.case.tables.later import later
from bumpstop.io.case.tables.table import Field, Kinds, Table
from bumpstop.io.case.tables.time import TimeKeys

if TYPE_CHECKING:
    from bumpstop.io.case.tables.random import DensityTable
else:
    DensityTable = later("random", "DensityTable")

__all__ = [
    "ForceTable",
    "GravityTable",
    "LineForceTable",
    "LoadTable",
    "MovingForceTable",
    "TurbulenceTable",
    "UnbalanceTable",
]


class ForceTable(TimeKeys):
    """A force on a node, from t = 0 on: constant, or times a function of time."""

    type: Literal["force"] = Field(description="Kind of load")
    node: Node = Field(description="The node it acts on")
    force: Force3 = Field(default=(0.0, 0.0, 0.0), description="Components along X, Y, Z, in N")
    moment: Moment3 = Field(default=(0.0, 0.0, 0.0), description="Components about X, Y, Z, in N m")


class LineForceTable(TimeKeys):
    """A force spread along a beam, uniform or changing linearly."""

    type: Literal["line_force"] = Field(description="Kind of load")
    beam: BeamName = Field(description="The beam it acts on")
    force: LineForce3 = Field(description="Components in N/m")
    end_force: LineForce3 | None = Field(
        default=None,
        description="Components in N/m at the end of the loaded length, where they differ; "
        "between, they change linearly",
    )
    start: Length = Field(default=0.0, description="Where it begins, in m from the first node")
    end: Length | None = Field(
        default=None, description="Where it ends, in m from the first node; at the last one else"
    )
    axes: Annotated[str, choice("global", "local")] = Field(
        default="global", description="Whether components are along X, Y, Z or the beam's own axes"
    )


class MovingForceTable(TimeKeys):
    """A force that travels along a beam at constant speed, and acts while it is on it."""

    type: Literal["moving_force"] = Field(description="Kind of load")
    beam: BeamName = Field(description="The beam it travels along")
    force: Force3 = Field(description="Components along X, Y, Z, in N")
    speed: Velocity = Field(
        description="In m/s from the first node to the last; negative for the other way"
    )
    enters: Time = Field(default=0.0, description="When it enters the beam, in s")


class GravityTable(Table):
    """Weight: the same acceleration on every mass of the structure."""

    type: Literal["gravity"] = Field(description="Kind of load")
    acceleration: Acceleration3 = Field(description="Components along X, Y, Z, in m/s2")


class TurbulenceTable(Table):
    """Random forces of a flow along a beam, correlated over a length."""

    type: Literal["turbulence"] = Field(description="Kind of load")
    beam: BeamName = Field(description="The beam it acts on")
    direction: Number3 = Field(description="Along which the force acts; its length multiplies it")
    psd: DensityTable = Field(
        description="One-sided spectral density of the force per length, in (N/m)^2/Hz"
    )
    correlation_length: PositiveLength = Field(
        description="Over which the coherence exp(-distance / length) falls, in m"
    )
    seed: CountFromZero = Field(description="A whole number that decides the phases")
    period: PositiveTime = Field(
        description="After how long it repeats itself, in s: not less than the run"
    )
    start: Length = Field(default=0.0, description="Where it begins, in m from the first node")
    end: Length | None = Field(
        default=None, description="Where it ends, in m from the first node; at the last one else"
    )
    cells: Count | None = Field(
        default=None,
        description="Cells in which the force is uniform; else four a correlation length, 32 at "
        "least and 128 at most",
    )


class UnbalanceTable(Table):
    """A mass out of the centre of a shaft that turns as ``[rotation]`` says."""

    type: Literal["unbalance"] = Field(description="Kind of load")
    node: Node = Field(description="The node it acts on")
    moment: PositiveNumber | None = Field(
        default=None, description="Mass times its distance from the centre, in kg m"
    )
    mass: Mass | None = Field(default=None, description="Instead of the moment: the mass, in kg")
    eccentricity: Length | None = Field(
        default=None, description="Instead of the moment: its distance from the centre, in m"
    )
    phase: Angle = Field(default=0.0, description="Angle of the mass in the shaft, in rad")
    axis: Number3 = Field(default=(1.0, 0.0, 0.0), description="Direction of the shaft")


LoadTable = Annotated[
    ForceTable
    | LineForceTable
    | MovingForceTable
    | GravityTable
    | TurbulenceTable
    | UnbalanceTable
    | SupportMotionTable,
    Kinds("type"),
]
