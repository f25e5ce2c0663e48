"""Our contacts, verified: by a scan of the response that knows nothing of how they were found.

A contact that was missed is a distance below zero while the stop is open; a false one is a
distance above zero while it is closed. Small structures are judged by matrix exponentials too.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from benchmarks.several.contacts import Contacts
from benchmarks.several.exact import closings
from tests.reference.problem import Array
from tests.reference.several.problem import SeveralStops
from tests.reference.several.scan import Event, ScanSolution
from tests.reference.several.verdict import compare, core_events

if TYPE_CHECKING:
    from bumpstop._core import History

PER_PERIOD = 100
ROUNDING = 1e-10
NUDGE = 1e-9
LARGEST_GROWTH = 1e4
JUDGED_MODES = 10


@dataclass(frozen=True)
class Truth:
    """A problem up to where small differences have grown too large, and its contacts."""

    problem: SeveralStops
    contacts: Contacts
    wrong: int  # samples at which a distance is on the wrong side of zero
    judged: bool | None  # whether matrix exponentials agree; None where they were not asked


def truth_of(problem: SeveralStops) -> Truth:
    """Find, limit and verify."""
    problem = problem.but(duration=horizon(problem))
    history = problem.solve()
    contacts = closings(problem, history)
    judged = None
    if problem.omega2.size <= JUDGED_MODES:
        judged = compare(problem, ScanSolution(problem)).difference is None
    return Truth(problem, contacts, wrong_samples(problem, history), judged)


def horizon(problem: SeveralStops) -> float:
    """Return how long a neighbour of this motion stays near it: a solver's errors grow alike."""
    rng = np.random.default_rng(1)
    size = np.abs(problem.velocity).max()
    nudge = NUDGE * size * rng.normal(size=problem.velocity.size)
    neighbour = problem.but(velocity=problem.velocity + nudge)
    times = np.linspace(0.0, problem.duration, 301)
    apart = neighbour.solve().motion(times, 1) - problem.solve().motion(times, 1)
    far = np.flatnonzero(np.abs(apart).max(axis=1) > LARGEST_GROWTH * NUDGE * size)
    return float(times[far[0]]) if far.size else problem.duration


def wrong_samples(problem: SeveralStops, history: "History") -> int:
    """Count samples of the response at which an open stop is crossed or a closed one left."""
    stiffest = sum(stop.stiffness * float(stop.row @ stop.row) for stop in problem.stops)
    fastest = np.sqrt(problem.omega2.max() + stiffest)
    times = np.arange(0.0, problem.duration, 2 * np.pi / (PER_PERIOD * fastest))
    events = core_events(history)
    wrong = 0
    for number in range(len(problem.stops)):
        distance = history.law_motion(number, times)[0]
        side = np.where(closed_at(times, events, number), -1.0, 1.0)
        wrong += int((side * distance < -ROUNDING * np.abs(distance).max()).sum())
    return wrong


def closed_at(times: Array, events: Sequence[Event], stop: int) -> NDArray[np.bool_]:
    """Return whether an undamped stop that starts open is closed at each time."""
    switches = [event.time for event in events if event.stop == stop]
    return np.asarray(np.searchsorted(switches, times, side="right") % 2 == 1)
