"""Blows on rigid stops: they take no time, and have an impulse but no force."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.post.impacts import Table, impacts_of

if TYPE_CHECKING:
    from bumpstop.problem import Law, Problem
    from bumpstop.response import Response

__all__ = ["Blows", "blow_table", "blows_of", "has_blows", "refuse_blows"]


class Blows(NamedTuple):
    """The blows on a stop, in the order of time."""

    times: FloatArray
    """In s, (n,)."""
    impulses: FloatArray
    """In N s, (n,)."""


def has_blows(law: Law) -> bool:
    """Return whether velocities jump at a law: whether it is a rigid stop."""
    return hasattr(law, "restitution")


def blows_of(response: Response, stop: int) -> Blows:
    """Return the blows on a stop, counted from 0; none where it gives way."""
    if not has_blows(response.problem.laws[stop]):
        return Blows(np.empty(0), np.empty(0))
    contacts = impacts_of(response, stop)
    sudden = contacts["duration"] == 0.0
    return Blows(contacts["start"][sudden], contacts["impulse"][sudden])


def blow_table(response: Response) -> Table:
    """Return the blows on all rigid stops as plain columns; see `Response.impulses`."""
    names = [law.name for law in response.problem.laws]
    found = [blows_of(response, stop) for stop in range(len(names))]
    times = np.concatenate([np.empty(0), *(blows.times for blows in found)])
    impulses = np.concatenate([np.empty(0), *(blows.impulses for blows in found)])
    owner = np.repeat(np.arange(len(names)), [len(blows.times) for blows in found])
    order = np.argsort(times, kind="stable")
    return {
        "time": times[order].tolist(),
        "stop": [names[stop] for stop in owner[order].tolist()],
        "impulse": impulses[order].tolist(),
    }


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
        if law.name == target[0] and has_blows(law):
            what = "is rigid: its force lacks the blows, which have an impulse but take no time"
            hint = "give it a stiffness, or take its impulses (impulses, force_spectrum)"
            raise InputError(what, key="stop", value=law.name, hint=hint)
