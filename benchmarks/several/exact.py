"""The exact method of bumpstop's core, timed by the core itself."""

from dataclasses import dataclass
from statistics import median
from typing import TYPE_CHECKING

from benchmarks.several.contacts import Contacts
from tests.reference.problem import CLOSED, OPEN
from tests.reference.several.problem import SeveralStops
from tests.reference.several.verdict import core_events

if TYPE_CHECKING:
    from bumpstop._core import History


@dataclass(frozen=True)
class Effort:
    """What a run took."""

    seconds: float
    events: int
    cells: int
    sets: int  # of stops that were closed together


class Exact:
    """Each run makes its system anew, so that no spectrum is kept."""

    name = "bumpstop exact"

    def find(self, problem: SeveralStops) -> Contacts:
        """Solve and list the closings."""
        return closings(problem, problem.solve())

    def effort(self, problem: SeveralStops, runs: int) -> Effort:
        """Solve several times; return the median time."""
        history = problem.solve()
        seconds = [history.seconds, *(problem.solve().seconds for _ in range(runs - 1))]
        closed: frozenset[int] = frozenset()
        sets = {closed}
        for event in core_events(history):
            closed = closed | {event.stop} if event.after == CLOSED else closed - {event.stop}
            sets.add(closed)
        return Effort(median(seconds), history.event_count, history.steps, len(sets))


def closings(problem: SeveralStops, history: "History") -> Contacts:
    """Return the contacts of a run."""
    found: list[list[float]] = [[] for _ in problem.stops]
    for event in core_events(history):
        if event.before == OPEN:
            found[event.stop].append(event.time)
    return Contacts(history.seconds, found)
