"""``[[outputs]]``."""

from bumpstop.io.case.fields.words import Node, OneDof
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["OutputTable"]


class OutputTable(Table):
    """A motion to be written to the results, beside those of the stops and gauges."""

    node: Node = Field(description="A node, or a point along a beam")
    dof: OneDof = Field(description="The displacement or rotation wanted")
