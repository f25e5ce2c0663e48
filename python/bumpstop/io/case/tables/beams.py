"""``[beams.NAME]``."""

from typing import Annotated

from pydantic import Field

from bumpstop.io.case.fields.counts import Count
from bumpstop.io.case.fields.words import BeamEnds, Name, choice
from bumpstop.io.case.tables.table import Table

__all__ = ["BeamTable"]


class BeamTable(Table):
    """A straight beam between two nodes, cut into equal elements.

    Its inner nodes are called ``AB.1``, ``AB.2``, ...; a point anywhere along it is written
    ``"AB@0.462 m"``.
    """

    nodes: BeamEnds = Field(description="Its first and last node")
    elements: Count = Field(description="Number of elements")
    theory: Annotated[str, choice("timoshenko")] = Field(
        default="timoshenko", description="Beam theory"
    )
    material: Name = Field(description="Name of one of the [materials]")
    section: Name = Field(description="Name of one of the [sections]")
