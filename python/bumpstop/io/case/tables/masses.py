"""``[masses.NAME]``."""

from pydantic import Field

from bumpstop.io.case.fields.quantities import Mass
from bumpstop.io.case.fields.words import Node
from bumpstop.io.case.tables.table import Table

__all__ = ["MassTable"]


class MassTable(Table):
    """A mass without size: it resists translation in every direction, not rotation."""

    node: Node = Field(description="The node that carries it")
    mass: Mass = Field(description="Mass, in kg")
