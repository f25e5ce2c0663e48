"""Which stops can be drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.laws import RigidStop, Stop

if TYPE_CHECKING:
    from bumpstop.problem import Problem

__all__ = ["fixed_stops"]


def fixed_stops(problem: Problem) -> list[Stop | RigidStop]:
    """Return the stops whose obstacle stays where it is, at one node."""
    stops = [law for law in problem.laws if isinstance(law, Stop | RigidStop)]
    return [stop for stop in stops if stop.other is None and stop.terms is None]
