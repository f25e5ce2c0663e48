"""Whether the motions that strain nothing are those that the user means."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from bumpstop.arguments import count
from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.free_motions import FreeMotion, free_motions
from bumpstop.structure.model import LinearModel
from bumpstop.structure.structure import Structure

__all__ = ["require_rigid_modes"]


def require_rigid_modes(model: LinearModel, announced: int | None) -> None:
    """Raise where the motions of a model that strain nothing are not those announced.

    Parameters
    ----------
    model
        The model.
    announced
        Their number; None where the user says nothing. Then a model in one piece may move as a
        whole, but neither come apart as a mechanism nor have a piece that moves by itself.

    Raises
    ------
    InputError
        Naming the motions.
    """
    if announced is None:
        if model.rigid_shapes().shape[1]:
            _refuse_unannounced(model)
        return
    wanted = count("rigid_modes", announced, least=0)
    motions = free_motions(model)
    if len(motions) != wanted:
        what = "no motion is free of strain"
        if motions:
            are = "motion is" if len(motions) == 1 else "motions are"
            what = f"{len(motions)} {are} free of strain: {_listed(motions)}"
        raise InputError(what, key="rigid_modes", value=announced)


def _refuse_unannounced(model: LinearModel) -> None:
    motions = free_motions(model)
    announce = f"say rigid_modes = {len(motions)}"
    if len(model.stiffness.values) == 0 and not isinstance(model, Structure):
        what = "the stiffness matrix is zero everywhere: nothing resists"
        raise InputError(what, key="rigid_modes", hint=f"is it the right one? If so, {announce}")
    mechanisms = [motion for motion in motions if motion.is_mechanism]
    if mechanisms:
        unknown = "" if _knows_positions(model) else "give positions, which tell what is rigid, or "
        raise InputError(
            f"a mechanism: {_listed(mechanisms)}",
            key="rigid_modes",
            hint=f"{unknown}hold or brace it, or {announce} if it is meant to move",
        )
    loose = list(dict.fromkeys(motion.piece for motion in motions if motion.piece))
    if loose:
        own = [replace(motion, piece="") for motion in motions if motion.piece == loose[0]]
        what = "a loose piece" if len(loose) == 1 else f"{len(loose)} loose pieces, the first"
        mend = f"join it by a part (a stop is none), hold it, or {announce}"
        raise InputError(
            f"{what}: {loose[0]}, free in {_listed(own)}",
            key="rigid_modes",
            hint=f"{mend} if it is meant to move",
        )


def _knows_positions(model: LinearModel) -> bool:
    try:
        for node in dict.fromkeys(node for node, dof in model.dofs if dof in DOFS):
            model.position(node)
    except InputError:
        return False
    return True


def _listed(motions: Sequence[FreeMotion], longest: int = 3) -> str:
    shown = "; ".join(motion.text for motion in motions[:longest])
    more = len(motions) - longest
    return shown + (f"; and {more} more" if more > 0 else "")
