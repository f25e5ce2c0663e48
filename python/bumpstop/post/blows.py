"""Blows on rigid stops: they take no time, and have an impulse but no force."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.errors import InputError

if TYPE_CHECKING:
    from bumpstop.problem import Problem

__all__ = ["refuse_blows"]


def refuse_blows(problem: Problem, quantity: str, *target: object) -> None:
    """Raise where a signal would lack the blows of a rigid stop, of which its force knows nothing.

    Parameters
    ----------
    problem
        Whose signal.
    quantity, target
        Which signal, as `Response.sample` takes it.

    Raises
    ------
    InputError
        If it is the force of a rigid stop: between blows that is what the structure rests on the
        stop with, and spectra and means of it would be those of a part of the force.
    """
    if quantity != "stop_force" or not target:
        return
    for law in problem.laws:
        if law.name == target[0] and hasattr(law, "restitution"):
            what = "is rigid: its force lacks the blows, which have an impulse but take no time"
            hint = "give it a stiffness, or take the impulses of contact_impacts"
            raise InputError(what, key="stop", value=law.name, hint=hint)
