"""What a solver found of a problem: when each stop closed, and how long it took to know."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from tests.reference.several.problem import SeveralStops


@dataclass(frozen=True)
class Contacts:
    """The closings of each stop, in s, and the time of the solution."""

    seconds: float
    closings: list[list[float]]

    @property
    def count(self) -> int:
        """Return how many there are."""
        return sum(len(times) for times in self.closings)


class Finder(Protocol):
    """Something that solves a problem and says when its stops closed."""

    name: str

    def find(self, problem: SeveralStops) -> Contacts:
        """Solve."""


def missed(true: Contacts, found: Contacts, window: float) -> int:
    """Return how many of the true closings have none of their own among those found near them."""
    pairs = zip(true.closings, found.closings, strict=True)
    return sum(_missed(wanted, list(had), window) for wanted, had in pairs)


def _missed(wanted: Sequence[float], had: list[float], window: float) -> int:
    lacking = 0
    for time in wanted:
        nearest = min(had, key=lambda other: abs(other - time), default=None)
        if nearest is None or abs(nearest - time) > window:
            lacking += 1
        else:
            had.remove(nearest)
    return lacking
