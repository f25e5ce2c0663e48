"""``[basis]`` and what it is computed from."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.io.case.build.structure import built_structure
from bumpstop.io.case.keys import keyed
from bumpstop.modal.basis import ModalBasis

if TYPE_CHECKING:
    from bumpstop.io.case.tables.case_file import CaseFile
    from bumpstop.modal.places import Place

__all__ = ["built_basis", "static_places"]


def built_basis(case: CaseFile) -> ModalBasis:
    """Return the modal basis of the case's structure."""
    with keyed():
        structure = built_structure(case)
    table = case.basis
    with keyed("basis"):
        return ModalBasis.from_structure(
            structure,
            modes=table.modes,
            damping=table.damping,
            damping_coupling=table.damping_coupling,
            static_shapes=static_places(case),
            constraint_shapes=table.constraint_shapes,
            base_shapes=table.base_shapes,
            static_damping=table.static_damping,
        )


def static_places(case: CaseFile) -> list[Place]:
    """Return where unit forces act whose static shapes join the modes."""
    if isinstance(case.basis.static_shapes, str):
        return [(stop.node, stop.normal) for stop in case.stops.values()]
    return case.basis.static_shapes
