"""The state at the start."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop import loads
from bumpstop.errors import InputError
from bumpstop.io.case.keys import keyed

if TYPE_CHECKING:
    from bumpstop.io.case.tables.initial import InitialTable
    from bumpstop.problem import InitialState

__all__ = ["built_initial", "state_key"]


def built_initial(table: InitialTable | None) -> InitialState | None:
    """Return the initial state that the table describes; None for rest."""
    if table is None:
        return None
    with keyed("initial"):
        given = _given(table)
        if not given:
            raise InputError("is empty", hint="give one of its keys, or leave [initial] out")
        if len(given) > 1:
            what = f"{' and '.join(given)} exclude each other"
            raise InputError(what, hint="give one of them")
        if table.rotation:
            return loads.RigidRotation(about=table.rotation.about, rate=table.rotation.rate)
        if table.translation:
            moving = table.translation
            return loads.RigidTranslation(moving.velocity, nodes=moving.nodes, beams=moving.beams)
        return loads.ModalState(**dict(table.modal or ()))


def state_key(table: InitialTable | None) -> str:
    """Return where in the file the initial state stands."""
    return ".".join(["initial", *(_given(table) if table else ())])


def _given(table: InitialTable) -> list[str]:
    return [key for key, state in table if state is not None]
