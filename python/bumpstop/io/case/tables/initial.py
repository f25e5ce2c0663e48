"""``[initial]``."""

from bumpstop.io.case.fields.quantities import (
    AngularRate3,
    Length,
    Numbers,
    Velocity,
    Velocity3,
)
from bumpstop.io.case.fields.words import BeamName, LoadNames, Node, OneDof
from bumpstop.io.case.tables.table import Field, Table

__all__ = [
    "InitialTable",
    "ModalStateTable",
    "NodalStateTable",
    "RotationTable",
    "StaticTable",
    "TranslationTable",
]


class RotationTable(Table):
    """The whole structure turns about a node, undeformed; what supports hold stays at rest."""

    about: Node = Field(description="The node that stays in place")
    rate: AngularRate3 = Field(description="Rotation vector about X, Y, Z, in rad/s")


class TranslationTable(Table):
    """Nodes move alike along a straight line and do not turn; supports hold none of them."""

    velocity: Velocity3 = Field(description="Velocity along X, Y, Z, in m/s")
    nodes: list[Node] | None = Field(
        default=None,
        description="The nodes that move; without nodes and beams the whole structure does",
    )
    beams: list[BeamName] | None = Field(default=None, description="Beams of which all nodes move")


class ModalStateTable(Table):
    """Displacement and velocity of each mode (unit modal mass); zero where left out."""

    displacement: Numbers | None = Field(default=None, description="One a mode, in m kg^0.5")
    velocity: Numbers | None = Field(default=None, description="One a mode, in m kg^0.5/s")


class StaticTable(Table):
    """Equilibrium at rest under loads, with stops and springs that take part."""

    loads: LoadNames = Field(
        default="all", description='The loads, as they are at t = 0: by name, or "all"'
    )
    release: LoadNames = Field(
        default=[],
        description='Which loads let go at t = 0 and are no loads of the run: by name, or "all"',
    )


class NodalStateTable(Table):
    """Displacements and velocities of nodes; zero where nothing is said."""

    displacement: dict[Node, dict[OneDof, Length]] | None = Field(
        default=None, description="Such as { B = { dy = 0.001 } }, in m and rad"
    )
    velocity: dict[Node, dict[OneDof, Velocity]] | None = Field(
        default=None, description="Such as { B = { dy = 0.2 } }, in m/s and rad/s"
    )


class InitialTable(Table):
    """How the structure moves at t = 0; at rest and undeformed where left out."""

    rotation: RotationTable | None = Field(default=None, description="A rigid rotation")
    translation: TranslationTable | None = Field(
        default=None, description="A velocity along a straight line"
    )
    static: StaticTable | None = Field(default=None, description="An equilibrium under loads")
    nodal: NodalStateTable | None = Field(default=None, description="A state given node by node")
    modal: ModalStateTable | None = Field(default=None, description="A state given mode by mode")
