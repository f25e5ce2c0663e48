"""Whether the motions that strain nothing are those that the user means."""

from __future__ import annotations

from collections.abc import Sequence

from bumpstop.arguments import count
from bumpstop.errors import InputError
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
        Their number; None where the user says nothing. Then connected pieces of a structure
        may move as a whole, but not come apart as mechanisms.

    Raises
    ------
    InputError
        Naming the motions.
    """
    if announced is None:
        if isinstance(model, Structure):
            _refuse_mechanisms(model)
        return
    wanted = count("rigid_modes", announced, least=0)
    motions = free_motions(model)
    if len(motions) != wanted:
        what = "no motion is free of strain"
        if motions:
            are = "motion is" if len(motions) == 1 else "motions are"
            what = f"{len(motions)} {are} free of strain: {_listed(motions)}"
        raise InputError(what, key="rigid_modes", value=announced)


def _refuse_mechanisms(structure: Structure) -> None:
    if structure.rigid_shapes().shape[1] == 0:
        return
    motions = free_motions(structure)
    mechanisms = [motion for motion in motions if motion.is_mechanism]
    if mechanisms:
        raise InputError(
            f"a mechanism: {_listed(mechanisms)}",
            key="rigid_modes",
            hint=f"hold or brace it, or say rigid_modes = {len(motions)} if it is meant to move",
        )


def _listed(motions: Sequence[FreeMotion], longest: int = 3) -> str:
    shown = "; ".join(motion.text for motion in motions[:longest])
    more = len(motions) - longest
    return shown + (f"; and {more} more" if more > 0 else "")
