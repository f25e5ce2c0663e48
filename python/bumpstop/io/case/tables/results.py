"""``[results.NAME]``: one table a type of result."""

from typing import Annotated, Literal

from bumpstop.io.case.fields.counts import Count
from bumpstop.io.case.fields.quantities import (
    Frequency,
    Length,
    Length2,
    Number,
    Numbers,
    PositiveLength,
    PositiveNumber,
    PositiveTime,
    Ratio,
    Time,
    Times,
)
from bumpstop.io.case.fields.words import (
    BeamName,
    Dofs,
    Name,
    Names,
    Node,
    OneDof,
    Text,
    choice,
)
from bumpstop.io.case.tables.table import Field, Kinds, Table
from bumpstop.post.response_spectrum import QUANTITIES
from bumpstop.post.results.spectra import SPECTRA

__all__ = ["ResultTable"]

SIGNALS = (
    "displacement",
    "velocity",
    "acceleration",
    "stop_force",
    "friction_force",
    "gap",
    "gauge",
)


class Window(Table):
    """The part of a run that is looked at."""

    start: Time = Field(default=0.0, description="When to begin, in s: the transient is left out")
    end: PositiveTime | None = Field(
        default=None, description="When to end, in s; with the run where left out"
    )


class StatisticsTable(Window):
    """Contact statistics of a stop."""

    type: Literal["contact_statistics"] = Field(description="Kind of result")
    stop: Name = Field(description="The stop")
    threshold: Ratio = Field(default=0.0, description="Force in N that an impact exceeds")
    rest: Time = Field(
        default=0.0, description="Time in s for which it must be unloaded between two impacts"
    )
    blocks: Count = Field(
        default=10, description="Blocks of time whose scatter gives the standard errors"
    )
    classes: Count = Field(default=10, description="Classes of histograms")


class WearTable(Window):
    """Wear at a stop after times of service."""

    type: Literal["wear"] = Field(description="Kind of result")
    stop: Name = Field(description="The stop")
    law: Annotated[str, choice("archard", "edf", "kwu_epri")] = Field(description="The wear law")
    coefficient: Ratio = Field(description="Wear coefficient, in SI units")
    exponent: Ratio = Field(default=1.2, description="Of the work rate, for edf")
    threshold: Ratio = Field(default=1.14e-16, description="Rate of wear at last in m3/s, for edf")
    slowing: PositiveNumber = Field(default=2.44e-8, description="How it slows in 1/s, for edf")
    impact: Ratio = Field(default=1.0, description="Coefficient of impacts, for kwu_epri")
    sliding: Ratio = Field(default=1.0, description="Coefficient of sliding, for kwu_epri")
    service: Times = Field(description="Times of service in s")
    radius: PositiveLength | None = Field(
        default=None, description="Outer radius in m of a tube, for the depth of its scar"
    )
    length: PositiveLength | None = Field(
        default=None, description="Length in m of the scar along the tube"
    )
    hole_radius: PositiveLength | None = Field(
        default=None, description="Radius in m of the hole; where left out the scar is a flat"
    )


class SectorTable(Window):
    """Work rate of a round contact by sectors of its circle."""

    type: Literal["work_by_sector"] = Field(description="Kind of result")
    stops: Names = Field(description="The stops that make up the obstacle, all at one node")
    sectors: Count = Field(default=8, description="Equal sectors, from the first axis on")
    axes: Dofs = Field(default=["dy", "dz"], description="The dofs that span its plane")
    centre: Length2 = Field(
        default=(0.0, 0.0), description="Its centre along them, from the node at rest, in m"
    )


class SpectrumTable(Window):
    """A spectrum or the envelope of a signal."""

    type: Literal["spectrum"] = Field(description="Kind of result")
    of: Annotated[str, choice(*SPECTRA)] = Field(
        default="density", description="Which spectrum: the power spectral density, and others"
    )
    quantity: Annotated[str, choice(*SIGNALS)] = Field(description="What the signal is")
    node: Node | None = Field(default=None, description="Of which node or point, for a motion")
    dof: OneDof | None = Field(default=None, description="Along or about which axis, for a motion")
    stop: Name | None = Field(default=None, description="Of which stop")
    gauge: Name | None = Field(default=None, description="Of which gauge")
    sample: PositiveTime = Field(description="Step of the samples, in s")
    segment: PositiveTime | None = Field(
        default=None, description="Length of the segments in s; an eighth of the signal else"
    )
    window: Text = Field(default="hann", description="Window of the segments, by SciPy's name")


class ResponseSpectrumTable(Window):
    """Response spectra of the absolute acceleration of a node."""

    type: Literal["response_spectrum"] = Field(description="Kind of result")
    node: Node = Field(description="The node or point that shakes the oscillators")
    dof: OneDof = Field(description="The direction")
    quantity: Annotated[str, choice(*QUANTITIES)] = Field(
        default="pseudo_acceleration", description="What is told of each oscillator"
    )
    damping: Numbers = Field(default=[0.05], description="Ratios of critical damping")
    lowest: Frequency = Field(description="Lowest frequency in Hz")
    highest: Frequency = Field(description="Highest frequency in Hz")
    points: Count = Field(default=100, description="Number of frequencies, in equal ratios")
    sample: PositiveTime = Field(description="Step of the samples of the acceleration, in s")


class SectionForcesTable(Table):
    """Normal and shear forces, torque and moments in a section of a beam."""

    type: Literal["section_forces"] = Field(description="Kind of result")
    beam: BeamName = Field(description="The beam")
    at: Length = Field(description="Distance from the beam's first node, in m")


class StressTable(Table):
    """Axial stress of a fibre of a beam."""

    type: Literal["stress"] = Field(description="Kind of result")
    beam: BeamName = Field(description="The beam")
    at: Length = Field(description="Distance from the beam's first node, in m")
    fibre: Length2 = Field(description="Place in the section: local y and z from its centre, in m")


class ReactionsTable(Table):
    """What supports do to a node."""

    type: Literal["reactions"] = Field(description="Kind of result")
    node: Node = Field(description="The node")


class SectionTable(Table):
    """A Poincaré section: displacement and velocity of a node once a period."""

    type: Literal["poincare"] = Field(description="Kind of result")
    node: Node = Field(description="The node or point")
    dof: OneDof = Field(description="The direction")
    period: PositiveTime = Field(description="Period in s, mostly that of the load")
    phase: Number = Field(default=0.0, description="When in the period, as a part of it")
    start: Time = Field(default=0.0, description="When to begin, in s: the transient is left out")


class LyapunovTable(Table):
    """Lyapunov exponents of the motion."""

    type: Literal["lyapunov"] = Field(description="Kind of result")
    exponents: Count = Field(default=1, description="How many, the largest first")
    start: Time = Field(default=0.0, description="When to begin, in s: the transient is left out")


ResultTable = Annotated[
    StatisticsTable
    | WearTable
    | SectorTable
    | SpectrumTable
    | ResponseSpectrumTable
    | SectionForcesTable
    | StressTable
    | ReactionsTable
    | SectionTable
    | LyapunovTable,
    Kinds("type"),
]
