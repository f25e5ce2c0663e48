"""``[basis]`` and what it is computed from."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.io.case.build.structure import built_structure
from bumpstop.io.case.keys import keyed
from bumpstop.modal.basis import ModalBasis

if TYPE_CHECKING:
    from bumpstop.io.case.tables.case_file import CaseFile

__all__ = ["built_basis"]


def built_basis(case: CaseFile) -> ModalBasis:
    """Return the modal basis of the case's structure."""
    with keyed():
        structure = built_structure(case)
    with keyed("basis"):
        return ModalBasis.from_structure(
            structure, modes=case.basis.modes, damping=case.basis.damping
        )
