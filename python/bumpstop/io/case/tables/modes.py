"""``[modes]``."""

from bumpstop.io.case.fields.masses import ModalMass
from bumpstop.io.case.fields.words import Text
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["ModesTable"]


class ModesTable(Table):
    """Modes of another program or of a measurement, instead of a structure.

    The lowest ones are taken, as many as [basis] says; its damping, where it is given, replaces
    that of the file.
    """

    file: Text = Field(description="File, relative to the case file: .csv, .npz, .uff, .unv")
    modal_mass: ModalMass | None = Field(
        default=None,
        description="Modal mass that belongs to the shapes, in kg: one for all modes or one a "
        "mode; what the file says where left out",
    )
