"""The state at the start."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop import loads
from bumpstop.errors import InputError
from bumpstop.io.case.keys import keyed

if TYPE_CHECKING:
    from bumpstop.io.case.tables.initial import InitialTable
    from bumpstop.problem import InitialState

__all__ = ["built_initial"]


def built_initial(table: InitialTable | None) -> InitialState | None:
    """Return the initial state that the table describes; None for rest."""
    if table is None:
        return None
    with keyed("initial"):
        if table.rotation and table.modal:
            raise InputError("rotation and modal exclude each other", hint="give one of them")
        if table.rotation:
            return loads.RigidRotation(about=table.rotation.about, rate=table.rotation.rate)
        if table.modal:
            state = table.modal
            return loads.ModalState(displacement=state.displacement, velocity=state.velocity)
        raise InputError("is empty", hint="give rotation or modal, or leave [initial] out")
