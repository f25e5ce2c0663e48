"""``[laws.NAME]``."""

from typing import Annotated

from bumpstop.io.case.fields.laws import Curve, Deformations, Slopes
from bumpstop.io.case.fields.quantities import DampingConstant, Force, Length, Number3
from bumpstop.io.case.fields.words import Node, OneDof, choice
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["LawTable"]


class LawTable(Table):
    """An elastic spring whose stiffness changes with its deformation, with a damper beside it."""

    type: Annotated[str, choice("spring")] = Field(description='The kind of law: "spring"')
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
