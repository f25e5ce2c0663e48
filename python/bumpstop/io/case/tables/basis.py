"""``[basis]``."""

from pydantic import Field

from bumpstop.io.case.fields.counts import Count
from bumpstop.io.case.fields.quantities import ModalDamping
from bumpstop.io.case.tables.table import Table

__all__ = ["BasisTable"]


class BasisTable(Table):
    """The modes on which the structure's motion is written."""

    modes: Count = Field(description="Number of modes, the lowest ones, rigid-body modes included")
    damping: ModalDamping = Field(
        default=0.0,
        description="Damping ratio (1 is critical) of every mode, or a list: one a mode",
    )
