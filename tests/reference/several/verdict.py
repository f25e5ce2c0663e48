"""Hold a run of the core against the judge: missed and false events, and the states."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from ..problem import OPEN, Array
from .problem import SeveralStops
from .scan import Event, Minimum, ScanSolution

if TYPE_CHECKING:
    from bumpstop._core import History

LARGEST_GROWTH = 1e6
SAMPLES = 24
EPSILON = float(np.finfo(float).eps)
EDGE = 1e-9  # of the run: events so near to its ends may fall on either side


class Judge(Protocol):
    """What an independent solution tells."""

    events: list[Event]
    minima: list[Minimum]
    end: float
    growth: float

    def motion(self, times: Array) -> tuple[Array, Array]:
        """Return displacement and velocity, each (time, mode)."""

    def growth_at(self, times: Array) -> Array:
        """Return how much a perturbation of the start may have grown."""


def core_events(history: "History") -> list[Event]:
    """Return the core's events."""
    columns: dict[str, Any] = dict(history.events())
    names = ("time", "law", "before", "after")
    return [Event(*row) for row in zip(*(columns[name] for name in names), strict=True)]


def inner(events: Sequence[Event], judge: "Judge") -> list[Event]:
    """Return the events that do not lie so near to the run's ends that rounding decides."""
    edge = judge.end * max(EDGE, 1e4 * EPSILON * judge.growth)
    return [event for event in events if edge < event.time < judge.end - edge]


def by_stop(events: Sequence[Event], stop: int, settle: float) -> list[Event]:
    """Return the events of one stop, without pairs that undo each other within an instant."""
    kept: list[Event] = []
    for event in events:
        if event.stop != stop:
            continue
        if kept and event.time - kept[-1].time <= settle and event.after == kept[-1].before:
            kept.pop()
        else:
            kept.append(event)
    return kept


@dataclass(frozen=True)
class Difference:
    """Where the events of one stop first differ."""

    stop: int
    time: float
    until: float  # when the list that has the event has the next one of this stop
    missed: bool  # or false: the core found one that is not there


def first_difference(
    expected: Sequence[Event], found: Sequence[Event], stops: int, end: float
) -> Difference | None:
    """Return the first event that only one of the lists has."""
    differences = []
    for stop in range(stops):
        left, right = by_stop(expected, stop, 1e-12 * end), by_stop(found, stop, 1e-12 * end)
        at = next(
            (n for n, pair in enumerate(zip(left, right, strict=False)) if not same(*pair, end)),
            min(len(left), len(right)),
        )
        if at == len(left) == len(right):
            continue
        missed = at == len(right) or (at < len(left) and left[at].time <= right[at].time)
        rest = left[at:] if missed else right[at:]
        until = rest[1].time if len(rest) > 1 else end
        differences.append(Difference(stop, rest[0].time, until, missed))
    return min(differences, key=lambda difference: difference.time, default=None)


def same(a: Event, b: Event, end: float) -> bool:
    """Return whether two events are one."""
    near = abs(a.time - b.time) <= 1e-3 * end
    return near and (a.before, a.after) == (b.before, b.after)


def undecidable(problem: SeveralStops, judge: Judge, difference: Difference) -> bool:
    """Return whether rounding decides over an event.

    Either a guard came so near to zero before that it may as well have crossed, or the distance
    stays so near to zero until the stop switches again.
    """
    blurred = 1e3 * EPSILON * judge.growth
    if any(m.height < blurred and m.time <= difference.time for m in judge.minima):
        return True
    stop = problem.stops[difference.stop]
    displacement = judge.motion(np.linspace(difference.time, difference.until, 9))[0]
    reach = np.abs(judge.motion(np.linspace(0.0, judge.end, 9))[0]).max()
    distance = np.abs(stop.gap + displacement @ stop.row).max()
    return bool(distance <= blurred * (np.abs(stop.row).sum() * reach + abs(stop.gap)))


@dataclass(frozen=True)
class Verdict:
    """How a run compares."""

    events: int
    difference: Difference | None
    undecidable: bool
    error: float  # of displacements, velocities and events' distances, relative to the largest
    excess: float  # the same over what is allowed: 1e-10 + 100 eps |V|
    energy: float  # the core's own residual of its ledger
    growth: float


def compare(problem: SeveralStops, judge: Judge | None = None) -> Verdict:
    """Solve with both, up to where perturbations have grown a millionfold."""
    judge = judge or ScanSolution(problem, LARGEST_GROWTH)
    history = problem.but(duration=judge.end).solve()
    inside, found = inner(judge.events, judge), inner(core_events(history), judge)
    difference = first_difference(inside, found, len(problem.stops), judge.end)
    horizon = difference.time if difference else judge.end
    grid = np.linspace(0.0, horizon, SAMPLES + 1)[1:]
    times = np.sort(np.append(grid, [e.time for e in inside if e.time < horizon]))
    errors = state_errors(judge, history, times)
    misplaced = event_errors(problem, judge, inside, found, horizon)
    allowed = 1e-10 + 100 * EPSILON * judge.growth_at(np.append(times, misplaced[0]))
    errors = np.append(errors, misplaced[1])
    open_question = difference is not None and undecidable(problem, judge, difference)
    return Verdict(
        events=len(inside),
        difference=difference,
        undecidable=open_question,
        error=float(errors.max()),
        excess=float((errors / allowed).max()),
        energy=history.energy_residual(),
        growth=judge.growth,
    )


def state_errors(judge: Judge, history: "History", times: Array) -> Array:
    """Return the error of the states at each time, relative to the largest."""
    errors = np.zeros(times.size)
    for derivative, wanted in enumerate(judge.motion(times)):
        size = np.abs(wanted).max() or 1.0
        apart = np.abs(history.motion(times, derivative) - wanted).max(axis=1)
        errors = np.maximum(errors, apart / size)
    return errors


def event_errors(
    problem: SeveralStops,
    judge: Judge,
    expected: Sequence[Event],
    found: Sequence[Event],
    horizon: float,
) -> tuple[Array, Array]:
    """Return instants at which stops close or open, and how far away the core's stop is then.

    That is the time between the two events times the speed, relative to the largest excursion:
    the instant of a graze is blurred, its place is not.
    """
    times, late, rows = [], [], []
    for number, stop in enumerate(problem.stops):
        lists = (by_stop(events, number, 1e-12 * judge.end) for events in (expected, found))
        for a, b in zip(*lists, strict=False):
            if a.time < horizon and OPEN in (a.before, a.after):
                times.append(a.time)
                late.append(abs(a.time - b.time))
                rows.append(stop.row)
    if not times:
        return np.zeros(0), np.zeros(0)
    displacement = judge.motion(np.linspace(0.0, horizon, SAMPLES + 1))[0]
    reach = (np.abs(displacement).max() or 1.0) * np.abs(rows).sum(axis=1)
    velocity = judge.motion(np.array(times))[1]
    speed = np.abs((velocity * rows).sum(axis=1))
    return np.array(times), np.array(late) * speed / reach
