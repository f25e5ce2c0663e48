"""``[modes]``."""

from bumpstop.io.case.fields.counts import Count
from bumpstop.io.case.fields.masses import ModalMass
from bumpstop.io.case.fields.modes import Band
from bumpstop.io.case.fields.words import Text
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["ModesTable"]


class ModesTable(Table):
    """Modes of another program or of a measurement, instead of a structure.

    The lowest ones are taken, as many as [basis] says; its damping, where it is given, replaces
    that of the file. Modes of measured functions (universal files with data sets 58) are
    identified first.
    """

    file: Text = Field(description="File, relative to the case file: .csv, .npz, .uff, .unv")
    band: Band | None = Field(
        default=None,
        description="Lowest and highest frequency at which modes of measured functions are "
        "identified, in Hz; all where left out",
    )
    count: Count | None = Field(
        default=None,
        description="How many modes of measured functions are kept, the strongest ones; all "
        "stable ones where left out",
    )
    modal_mass: ModalMass | None = Field(
        default=None,
        description="Modal mass that belongs to the shapes, in kg: one for all modes or one a "
        "mode; what the file says where left out",
    )
