"""``[[references]]``."""

from typing import Annotated

from bumpstop.io.case.fields.counts import Count, Switch
from bumpstop.io.case.fields.quantities import PositiveNumber, Times, Written, WrittenList
from bumpstop.io.case.fields.words import Name, Node, OneDof, Text, choice
from bumpstop.io.case.tables.table import Field, Table
from bumpstop.post.references import REFERENCE_QUANTITIES

__all__ = ["ReferenceTable"]


class ReferenceTable(Table):
    """Known values of one quantity, published or in closed form."""

    variant: Name | None = Field(
        default=None, description="The variant that it belongs to; every one where left out"
    )
    quantity: Annotated[str, choice(*REFERENCE_QUANTITIES)] = Field(
        description="What the values are of"
    )
    node: Node | None = Field(default=None, description="Of which node or point, for a motion")
    dof: OneDof | None = Field(default=None, description="Along or about which axis, for a motion")
    mode: Count | None = Field(default=None, description="Of which mode, counted from 1")
    modes: list[Count] | None = Field(
        default=None, description="Of which modes, for frequencies: one a value"
    )
    stop: Name | None = Field(default=None, description="Of which stop")
    gauge: Name | None = Field(default=None, description="Of which gauge")
    term: Name | None = Field(default=None, description="Which term of the energy ledger")
    impact: Count | None = Field(default=None, description="Of which impact, counted from 1")
    sampled: Switch = Field(
        default=False,
        description="For an impact: counted from the samples, as many published tables are",
    )
    times: Times | None = Field(
        default=None, description="When, in s, in ascending order; only for quantities of time"
    )
    values: WrittenList = Field(description="The known values, one a time or mode, in SI units")
    tolerance: PositiveNumber | None = Field(
        default=None, description="Largest deviation, relative to each value"
    )
    relative_tolerance: PositiveNumber | None = Field(
        default=None, description="The same as tolerance, by its full name"
    )
    absolute_tolerance: Written | None = Field(
        default=None, description="Largest deviation, in the unit of the values"
    )
    source: Text = Field(default="", description="Where the values come from")
    of_model: Switch = Field(
        default=False,
        description="Whether the values were computed with this very model, its modes and its "
        "mesh: they do not tell it from a finer one",
    )
