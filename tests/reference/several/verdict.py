"""Hold a run of the core against the judge: missed and false events, and the states."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from ..problem import Array
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


@dataclass(frozen=True)
class Difference:
    """Where the events of one stop first differ."""

    stop: int
    time: float
    missed: bool  # or false: the core found one that is not there
    undecidable: bool  # a guard came so near to zero there that rounding decides


@dataclass(frozen=True)
class Verdict:
    """How a run compares."""

    events: int
    difference: Difference | None
    error: float  # of displacement and velocity, relative to the largest
    excess: float  # the same over what is allowed: 1e-10 + 100 eps |V|
    growth: float


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


def first_difference(
    expected: Sequence[Event], found: Sequence[Event], stops: int, duration: float
) -> tuple[int, float, bool] | None:
    """Return the first stop, instant and kind (missed?) at which two lists of events differ."""
    settle = 1e-12 * duration
    firsts = []
    for stop in range(stops):
        left, right = by_stop(expected, stop, settle), by_stop(found, stop, settle)
        for n in range(max(len(left), len(right))):
            a = left[n] if n < len(left) else None
            b = right[n] if n < len(right) else None
            near = a is not None and b is not None and abs(a.time - b.time) <= 1e-3 * duration
            if a and b and near and (a.before, a.after) == (b.before, b.after):
                continue
            missed = b is None or (a is not None and a.time <= b.time)
            first = a if missed else b
            assert first is not None
            firsts.append((first.time, stop, missed))
            break
    if not firsts:
        return None
    time, stop, missed = min(firsts)
    return stop, time, missed


def compare(problem: SeveralStops, judge: Judge | None = None) -> Verdict:
    """Solve with both, up to where perturbations have grown a millionfold."""
    judge = judge or ScanSolution(problem, LARGEST_GROWTH)
    problem = problem.but(duration=judge.end)
    history = problem.solve()
    inside, found = inner(judge.events, judge), inner(core_events(history), judge)
    differs = first_difference(inside, found, len(problem.stops), judge.end)
    difference = None
    horizon = judge.end
    if differs is not None:
        stop, time, missed = differs
        blurred = 1e3 * EPSILON * judge.growth
        close = [m for m in judge.minima if m.height < blurred and m.time <= time * (1 + 1e-6)]
        difference = Difference(stop, time, missed, bool(close))
        horizon = time
    grid = np.linspace(0.0, horizon, SAMPLES + 1)[1:]
    times = np.sort(np.append(grid, [e.time for e in inside if e.time < horizon]))
    error, excess = state_errors(judge, history, times)
    return Verdict(len(inside), difference, error, excess, judge.growth)


def state_errors(judge: Judge, history: "History", times: Array) -> tuple[float, float]:
    """Return the worst relative error of the states, and relative to what is allowed."""
    displacement, velocity = judge.motion(times)
    errors = np.zeros(times.size)
    for derivative, wanted in enumerate((displacement, velocity)):
        size = np.abs(wanted).max() or 1.0
        apart = np.abs(history.motion(times, derivative) - wanted).max(axis=1)
        errors = np.maximum(errors, apart / size)
    allowed = 1e-10 + 100 * EPSILON * judge.growth_at(times)
    return float(errors.max()), float((errors / allowed).max())
