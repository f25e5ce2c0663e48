"""``[beams.NAME]``."""

from typing import Annotated

from bumpstop.io.case.fields.counts import Count
from bumpstop.io.case.fields.quantities import Angle, AngularRate, Force, LineMass
from bumpstop.io.case.fields.words import BeamEnds, Name, choice
from bumpstop.io.case.tables.table import Field, Table
from bumpstop.structure.elements import THEORIES

__all__ = ["BeamPropertiesTable", "BeamTable"]


class BeamPropertiesTable(Table):
    """What a beam is, wherever it is."""

    elements: Count = Field(description="Number of elements")
    theory: Annotated[str, choice(*THEORIES)] = Field(
        default="timoshenko", description="Beam theory; a bar resists stretching alone"
    )
    material: Name = Field(description="Name of one of the [materials]")
    section: Name = Field(description="Name of one of the [sections]")
    end_section: Name | None = Field(
        default=None,
        description="Name of the section at its last node, if other; in between it changes evenly",
    )
    roll: Angle = Field(default=0.0, description="Turns local y and z about local x, in rad")
    mass: Annotated[str, choice("consistent", "lumped")] = Field(
        default="consistent", description="Kind of mass matrix"
    )
    added_mass: LineMass = Field(
        default=0.0, description="Mass that moves with it in every direction, in kg/m"
    )
    tension: Force = Field(default=0.0, description="Constant axial force, in N")
    spin: AngularRate = Field(
        default=0.0, description="Constant speed of rotation about local x, in rad/s"
    )


class BeamTable(BeamPropertiesTable):
    """A straight beam between two nodes, cut into equal elements.

    Its inner nodes are called ``AB.1``, ``AB.2``, ...; a point anywhere along it is written
    ``"AB@0.462 m"``.
    """

    nodes: BeamEnds = Field(description="Its first and last node")
