"""The tables that make a structure: those of a case, and those of each of its components."""

from typing import TYPE_CHECKING

from bumpstop.io.case.fields.quantities import Length3
from bumpstop.io.case.fields.words import Name, NodeName
from bumpstop.io.case.tables.beams import BeamTable
from bumpstop.io.case.tables.later import later
from bumpstop.io.case.tables.materials import MaterialTable
from bumpstop.io.case.tables.sections import SectionTable
from bumpstop.io.case.tables.supports import SupportTable
from bumpstop.io.case.tables.table import Field, Table

# What a case need not have is loaded with those that have it.
if TYPE_CHECKING:
    from bumpstop.io.case.tables.bearings import BearingTable
    from bumpstop.io.case.tables.links import LinkTable
    from bumpstop.io.case.tables.masses import MassTable
    from bumpstop.io.case.tables.relations import RelationTable
    from bumpstop.io.case.tables.springs import SpringTable
else:
    BearingTable = later("bearings", "BearingTable")
    LinkTable = later("links", "LinkTable")
    MassTable = later("masses", "MassTable")
    RelationTable = later("relations", "RelationTable")
    SpringTable = later("springs", "SpringTable")

__all__ = ["StructureTables"]


class StructureTables(Table):
    """Nodes, what stands between and on them, and what holds them."""

    nodes: dict[NodeName, Length3] = Field(default={}, description="Named points: x, y and z, in m")
    materials: dict[Name, MaterialTable] = Field(default={}, description="Materials, by name")
    sections: dict[Name, SectionTable] = Field(default={}, description="Cross sections, by name")
    beams: dict[Name, BeamTable] = Field(default={}, description="Beams, by name")
    masses: dict[Name, MassTable] = Field(default={}, description="Masses and bodies, by name")
    springs: dict[Name, SpringTable] = Field(default={}, description="Springs, by name")
    bearings: dict[Name, BearingTable] = Field(default={}, description="Bearings, by name")
    supports: list[SupportTable] = Field(default=[], description="What is held, and where")
    relations: list[RelationTable] = Field(default=[], description="Sums of dofs that stay zero")
    links: dict[Name, LinkTable] = Field(default={}, description="Rigid links, by name")
