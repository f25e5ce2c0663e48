"""Which stops can be drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.laws.contact import Contact

if TYPE_CHECKING:
    from bumpstop.problem import Problem

__all__ = ["fixed_stops"]


def fixed_stops(problem: Problem) -> list[Contact]:
    """Return the stops whose obstacle stays where it is, at one node."""
    stops = [law for law in problem.laws if isinstance(law, Contact)]
    return [stop for stop in stops if stop.other is None and stop.terms is None]
