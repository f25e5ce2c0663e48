"""``[mesh]``."""

from bumpstop.io.case.fields.counts import Count
from bumpstop.io.case.fields.quantities import PositiveLength
from bumpstop.io.case.fields.words import Group, Text
from bumpstop.io.case.tables.beams import BeamPropertiesTable
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["MeshBeamTable", "MeshTable"]


class MeshBeamTable(BeamPropertiesTable):
    """The beams on the lines of a group, each called like its line."""

    elements: Count = Field(default=1, description="Number of elements on each line")


class MeshTable(Table):
    """Nodes and lines of a mesh, instead of nodes.

    A node that is alone in a group has the group's name; supports may name groups of nodes.
    """

    file: Text = Field(description="File, relative to the case file: .msh, .mail, .med")
    unit: PositiveLength = Field(
        default=1.0, description='Length that a coordinate of 1 means, such as "1 mm"'
    )
    beams: dict[Group, MeshBeamTable] = Field(
        description="Beams on the lines of each group, by the group's name"
    )
