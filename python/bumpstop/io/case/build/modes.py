"""``[modes]``: a basis from a file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from bumpstop.errors import InputError
from bumpstop.io.case.keys import keyed
from bumpstop.io.case.tables.table import written_keys
from bumpstop.io.modes.read import read_modes

if TYPE_CHECKING:
    from bumpstop.io.case.tables.case_file import CaseFile
    from bumpstop.io.case.tables.modes import ModesTable
    from bumpstop.modal.basis import ModalBasis

__all__ = ["built_modes"]

_OF_STRUCTURES = (
    "damping_coupling",
    "static_shapes",
    "constraint_shapes",
    "base_shapes",
    "load_shapes",
    "static_damping",
    "rigid_modes",
)
"""Keys of [basis] that ask for matrices."""
_KEYS = {"modes": "basis.modes", "damping": "basis.damping", "modal_mass": "modes.modal_mass"}
"""Where the arguments of a basis stand in the file."""


def built_modes(case: CaseFile, table: ModesTable, folder: Path) -> ModalBasis:
    """Return the basis of the modes that the file holds."""
    said = written_keys(case.basis)
    for key in _OF_STRUCTURES:
        if key in said:
            hint = "leave it out: modes from a file have none"
            raise InputError("needs a structure", key=f"basis.{key}", hint=hint)
    with keyed("modes"):
        given = read_modes(folder / table.file, band=table.band, count=table.count)
    with keyed(renamed=_KEYS):
        return given.basis(
            modes=case.basis.modes,
            damping=case.basis.damping if "damping" in said else None,
            modal_mass=table.modal_mass,
        )
