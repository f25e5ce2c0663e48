"""``[initial]``."""

from bumpstop.io.case.fields.quantities import AngularRate3, Numbers, Velocity3
from bumpstop.io.case.fields.words import BeamName, Node
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["InitialTable", "ModalStateTable", "RotationTable", "TranslationTable"]


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


class InitialTable(Table):
    """How the structure moves at t = 0; at rest and undeformed where left out."""

    rotation: RotationTable | None = Field(default=None, description="A rigid rotation")
    translation: TranslationTable | None = Field(
        default=None, description="A velocity along a straight line"
    )
    modal: ModalStateTable | None = Field(default=None, description="A state given mode by mode")
