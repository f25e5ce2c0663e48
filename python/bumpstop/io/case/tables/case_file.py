"""The whole case file."""

from typing import Any

from pydantic import Field

from bumpstop.io.case.fields.quantities import Length3
from bumpstop.io.case.fields.words import Name, NodeName, Text
from bumpstop.io.case.tables.basis import BasisTable
from bumpstop.io.case.tables.beams import BeamTable
from bumpstop.io.case.tables.gauges import GaugeTable
from bumpstop.io.case.tables.initial import InitialTable
from bumpstop.io.case.tables.links import LinkTable
from bumpstop.io.case.tables.loads import LoadTable
from bumpstop.io.case.tables.masses import MassTable
from bumpstop.io.case.tables.materials import MaterialTable
from bumpstop.io.case.tables.matrices import MatricesTable
from bumpstop.io.case.tables.modes import ModesTable
from bumpstop.io.case.tables.outputs import OutputTable
from bumpstop.io.case.tables.references import ReferenceTable
from bumpstop.io.case.tables.relations import RelationTable
from bumpstop.io.case.tables.run import RunTable
from bumpstop.io.case.tables.sections import SectionTable
from bumpstop.io.case.tables.stops import StopTable
from bumpstop.io.case.tables.supports import SupportTable
from bumpstop.io.case.tables.table import Table

__all__ = ["CaseFile"]


class CaseFile(Table):
    """A bumpstop case: a structure, what it hits, how it starts, and what is known of it.

    Physical numbers are in SI units, or strings with their unit such as "18 kN/m".
    """

    title: Text = Field(default="", description="What the case is, in one line")
    description: Text = Field(default="", description="More about it, in any number of lines")
    nodes: dict[NodeName, Length3] = Field(default={}, description="Named points: x, y and z, in m")
    matrices: MatricesTable | None = Field(
        default=None, description="Instead of nodes: matrices from files"
    )
    modes: ModesTable | None = Field(default=None, description="Instead of nodes: modes of a file")
    materials: dict[Name, MaterialTable] = Field(default={}, description="Materials, by name")
    sections: dict[Name, SectionTable] = Field(default={}, description="Cross sections, by name")
    beams: dict[Name, BeamTable] = Field(default={}, description="Beams, by name")
    masses: dict[Name, MassTable] = Field(default={}, description="Point masses, by name")
    supports: list[SupportTable] = Field(default=[], description="What is held, and where")
    relations: list[RelationTable] = Field(default=[], description="Sums of dofs that stay zero")
    links: dict[Name, LinkTable] = Field(default={}, description="Rigid links, by name")
    basis: BasisTable = Field(description="Modes of the structure")
    stops: dict[Name, StopTable] = Field(default={}, description="Stops, by name")
    loads: dict[Name, LoadTable] = Field(default={}, description="Loads, by name")
    initial: InitialTable | None = Field(default=None, description="The state at t = 0")
    gauges: dict[Name, GaugeTable] = Field(default={}, description="Strain gauges, by name")
    outputs: list[OutputTable] = Field(default=[], description="More motions to write to files")
    run: RunTable = Field(description="For how long to simulate, and how")
    variants: dict[Name, dict[str, Any]] = Field(
        default={},
        description='The same case with other values, each by its dotted name: "stops.guide.gap"',
    )
    references: list[ReferenceTable] = Field(
        default=[], description="Known values that the results are checked against"
    )
