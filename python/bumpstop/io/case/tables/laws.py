"""``[laws.NAME]``: one table a type of law."""

from typing import Annotated, Literal

from bumpstop.io.case.fields.laws import Curve, Deformations, Slopes
from bumpstop.io.case.fields.quantities import (
    DampingConstant,
    Force,
    Length,
    Number3,
    PositiveNumber,
    Stiffness,
)
from bumpstop.io.case.fields.words import Node, OneDof
from bumpstop.io.case.tables.table import Field, Kinds, Table

__all__ = ["LawTable", "SpringLawTable", "ZenerDamperTable"]


class ConnectionTable(Table):
    """What laws that hold a node have."""

    node: Node | None = Field(default=None, description="The node that it holds")
    direction: Number3 | None = Field(
        default=None, description="Direction in which its deformation is measured"
    )
    other: Node | None = Field(
        default=None, description="The node that holds it; the ground where left out"
    )
    terms: dict[Node, dict[OneDof, Length]] | None = Field(
        default=None,
        description="Instead of node, direction and other: weights of dofs in the deformation; "
        "that of a rotation is a length, in m",
    )


class SpringLawTable(ConnectionTable):
    """An elastic spring whose stiffness changes with its deformation, with a damper beside it."""

    type: Literal["spring"] = Field(description="Kind of law")
    stiffness: Slopes | None = Field(
        default=None,
        description="Slope of the force in each segment, in N/m, one more than breaks; zero for "
        "play, negative for buckling",
    )
    breaks: Deformations | None = Field(
        default=None, description="Deformations at which the slope changes, increasing, in m"
    )
    preload: Force | None = Field(
        default=None, description="Force that resists at no deformation, in N"
    )
    curve: Curve | None = Field(
        default=None,
        description="Instead of stiffness, breaks and preload: points [deformation, force] that "
        "the force runs through, in m and N",
    )
    damping: DampingConstant = Field(default=0.0, description="Damping constant, in N s/m")


class ZenerDamperTable(ConnectionTable):
    """A viscous damper with springs: one in series with a spring beside a spring and a dashpot."""

    type: Literal["zener"] = Field(description="Kind of law")
    series_stiffness: Stiffness = Field(
        description="Stiffness of the spring in series with all else, in N/m"
    )
    parallel_stiffness: Stiffness | None = Field(
        default=None,
        description="Stiffness of the spring beside the dashpot and its spring, in N/m",
    )
    branch_stiffness: Stiffness = Field(
        description="Stiffness of the spring in series with the dashpot, in N/m"
    )
    damping: PositiveNumber = Field(description="Force of the dashpot at 1 m/s, in N")
    exponent: PositiveNumber = Field(
        default=1.0, description="Power of the speed that its force goes with, at most 1"
    )


LawTable = Annotated[SpringLawTable | ZenerDamperTable, Kinds("type")]
