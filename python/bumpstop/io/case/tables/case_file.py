"""The whole case file."""

from typing import TYPE_CHECKING, Any

from bumpstop.io.case.fields.words import Name, Text
from bumpstop.io.case.tables.basis import BasisTable
from bumpstop.io.case.tables.gauges import GaugeTable
from bumpstop.io.case.tables.initial import InitialTable
from bumpstop.io.case.tables.later import later
from bumpstop.io.case.tables.references import ReferenceTable
from bumpstop.io.case.tables.run import RunTable
from bumpstop.io.case.tables.stops import StopTable
from bumpstop.io.case.tables.structure import StructureTables

# What a case need not have is loaded with those that have it.
if TYPE_CHECKING:
    from bumpstop.io.case.tables.base_motion import BaseMotionTable
    from bumpstop.io.case.tables.components import ComponentTable
    from bumpstop.io.case.tables.joints import JointTable
    from bumpstop.io.case.tables.laws import LawTable
    from bumpstop.io.case.tables.loads import LoadTable
    from bumpstop.io.case.tables.matrices import MatricesTable
    from bumpstop.io.case.tables.mesh import MeshTable
    from bumpstop.io.case.tables.modes import ModesTable
    from bumpstop.io.case.tables.outputs import OutputTable
    from bumpstop.io.case.tables.parts import PartTable
    from bumpstop.io.case.tables.results import ResultTable
    from bumpstop.io.case.tables.rotation import RotationTable
else:
    BaseMotionTable = later("base_motion", "BaseMotionTable")
    ComponentTable = later("components", "ComponentTable")
    JointTable = later("joints", "JointTable")
    LawTable = later("laws", "LawTable")
    LoadTable = later("loads", "LoadTable")
    MatricesTable = later("matrices", "MatricesTable")
    MeshTable = later("mesh", "MeshTable")
    ModesTable = later("modes", "ModesTable")
    OutputTable = later("outputs", "OutputTable")
    PartTable = later("parts", "PartTable")
    ResultTable = later("results", "ResultTable")
    RotationTable = later("rotation", "RotationTable")
from bumpstop.io.case.tables.table import Field

__all__ = ["CaseFile"]


class CaseFile(StructureTables):
    """A bumpstop case: a structure, what it hits, how it starts, and what is known of it.

    Physical numbers are in SI units, or strings with their unit such as "18 kN/m".
    """

    title: Text = Field(default="", description="What the case is, in one line")
    description: Text = Field(default="", description="More about it, in any number of lines")
    mesh: MeshTable | None = Field(
        default=None, description="Instead of nodes: those of a mesh, with beams on its lines"
    )
    matrices: MatricesTable | None = Field(
        default=None, description="Instead of nodes: matrices from files"
    )
    modes: ModesTable | None = Field(default=None, description="Instead of nodes: modes of a file")
    components: dict[Name, ComponentTable] = Field(
        default={}, description="Structures to be placed as parts, by name"
    )
    parts: dict[Name, PartTable] = Field(
        default={}, description="Instead of nodes: components in their places, by name"
    )
    joints: list[JointTable] = Field(default=[], description="Where parts hang together")
    basis: BasisTable = Field(description="Modes of the structure")
    stops: dict[Name, StopTable] = Field(default={}, description="Stops, by name")
    laws: dict[Name, LawTable] = Field(
        default={}, description="Local nonlinearities other than stops, by name"
    )
    loads: dict[Name, LoadTable] = Field(default={}, description="Loads, by name")
    base_motion: BaseMotionTable | None = Field(
        default=None, description="How the supports move, all together"
    )
    rotation: RotationTable | None = Field(default=None, description="How the shafts turn")
    initial: InitialTable | None = Field(default=None, description="The state at t = 0")
    gauges: dict[Name, GaugeTable] = Field(default={}, description="Strain gauges, by name")
    outputs: list[OutputTable] = Field(default=[], description="More motions to write to files")
    results: dict[Name, ResultTable] = Field(
        default={}, description="What else to read out of a run for its report, by name"
    )
    run: RunTable | None = Field(
        default=None,
        description="For how long to simulate, and how; without it a case is about modes alone",
    )
    variants: dict[Name, dict[str, Any]] = Field(
        default={},
        description='The same case with other values, each by its dotted name: "stops.guide.gap"',
    )
    references: list[ReferenceTable] = Field(
        default=[], description="Known values that the results are checked against"
    )
