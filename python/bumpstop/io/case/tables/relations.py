"""``[[relations]]``."""

from bumpstop.io.case.fields.quantities import Length
from bumpstop.io.case.fields.words import Node, OneDof
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["RelationTable"]


class RelationTable(Table):
    """A weighted sum of dofs that stays zero."""

    terms: dict[Node, dict[OneDof, Length]] = Field(
        description="Weights by node and dof, such as { A.dx = 2.0, B.dx = -1.0 }; "
        "that of a rotation beside displacements is a length, in m"
    )
