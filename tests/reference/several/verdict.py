"""Hold a run of the core against the judge: missed and false events, and the states."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from ..problem import OPEN, Array
from .impacts import Tail
from .laws.rigid_stop import RESTING
from .laws.spring import Spring
from .problem import SeveralStops
from .scan import Event, Minimum, ScanSolution

if TYPE_CHECKING:
    from bumpstop._core import History

LARGEST_GROWTH = 1e6
SAMPLES = 24
EPSILON = float(np.finfo(float).eps)
LARGEST_STATED = 1e-11  # of the sizes of a distance: what a run may say that it could have missed
EDGE = 1e-9  # of the run: events so near to its ends may fall on either side


class Judge(Protocol):
    """What an independent solution tells."""

    events: list[Event]
    minima: list[Minimum]
    end: float

    @property
    def tails(self) -> Sequence[Tail]:
        """Stretches in which rebounds come to their end."""

    @property
    def growth(self) -> float:
        """How much a perturbation may have grown."""

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


def by_stop(
    events: Sequence[Event], stop: int, settle: float, tails: Sequence[Tail] = ()
) -> list[Event]:
    """Return the events of one law, each with what follows it within an instant or in a tail.

    Those that undo each other are none. A tail is where rebounds come to their end, of one stop
    and of whatever else is touched in its rhythm.
    """
    chains: list[list[Event]] = []
    for event in events:
        if event.stop != stop:
            continue
        last = chains[-1][-1] if chains else None
        if last is not None and (
            event.time - last.time <= settle or (in_tail(last, tails) and in_tail(event, tails))
        ):
            chains[-1].append(event)
        else:
            chains.append([event])
    joined = [Event(chain[-1].time, stop, chain[0].before, chain[-1].after) for chain in chains]
    pairs = zip(joined, chains, strict=True)
    return [event for event, chain in pairs if len(chain) == 1 or event.before != event.after]


def in_tail(event: Event, tails: Sequence[Tail]) -> bool:
    """Return whether an event lies where rebounds come to their end."""
    return any(t.start * (1 - 1e-7) <= event.time <= t.end * (1 + 1e-7) for t in tails)


@dataclass(frozen=True)
class Difference:
    """Where the events of one stop first differ."""

    stop: int
    time: float
    until: float  # when the list that has it has the next one of this stop, or the other has it
    missed: bool  # or false: the core found one that is not there


def first_difference(
    expected: Sequence[Event],
    found: Sequence[Event],
    stops: int,
    end: float,
    tails: Sequence[Tail] = (),
) -> Difference | None:
    """Return the first event that only one of the lists has."""
    differences = []
    for stop in range(stops):
        lists = (by_stop(events, stop, 1e-12 * end, tails) for events in (expected, found))
        left, right = lists
        at = next(
            (n for n, pair in enumerate(zip(left, right, strict=False)) if not same(*pair, end)),
            min(len(left), len(right)),
        )
        if at == len(left) == len(right):
            continue
        missed = at == len(right) or (at < len(left) and left[at].time <= right[at].time)
        rest, other = (left[at:], right[at:]) if missed else (right[at:], left[at:])
        until = rest[1].time if len(rest) > 1 else end
        if other and other[0].states == rest[0].states:
            until = min(until, other[0].time)
        differences.append(Difference(stop, rest[0].time, until, missed))
    return min(differences, key=lambda difference: difference.time, default=None)


def same(a: Event, b: Event, end: float) -> bool:
    """Return whether two events are one."""
    near = abs(a.time - b.time) <= 1e-3 * end
    return near and (a.before, a.after) == (b.before, b.after)


def undecidable(problem: SeveralStops, judge: Judge, difference: Difference, stated: float) -> bool:
    """Return whether rounding decides over an event.

    Either a guard came so near to zero before that it may as well have crossed, or the distance
    stays so near to zero until the law switches again, or the other list has it, too. Near is what
    rounding makes of the reference motion, a thousand of its units times the growth of
    perturbations. It is also the penetration that the run says it could have missed (``stated``, in
    m): motions of heavy damping come to rest at the very gap, and cross it as slowly as one likes.
    That counts as far as it is rounding, 1e-11 of the sizes that the distance is the sum of: who
    says to have missed more is not excused.
    """
    blurred = 1e3 * EPSILON * judge.growth
    if any(m.height < blurred and m.time <= difference.time for m in judge.minima):
        return True
    row, gap = problem.laws[difference.stop].coordinates[0]
    displacement = judge.motion(np.linspace(difference.time, difference.until, 9))[0]
    # Heavily damped motions are large for a moment only.
    reach = np.abs(judge.motion(np.linspace(0.0, judge.end, 513))[0]).max()
    distance = np.abs(gap + displacement @ row).max()
    size = np.abs(row).sum() * reach + abs(gap)
    return bool(distance <= max(blurred * size, min(stated, LARGEST_STATED * size)))


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
    if judge is None:
        judge = ScanSolution(problem, LARGEST_GROWTH)
    if judge.end == 0.0:
        return Verdict(0, None, True, 0.0, 0.0, 0.0, judge.growth)
    history = problem.but(duration=judge.end).solve()
    inside, found = inner(judge.events, judge), inner(core_events(history), judge)
    difference = first_difference(inside, found, len(problem.laws), judge.end, judge.tails)
    horizon = difference.time if difference else judge.end
    grid = np.linspace(0.0, horizon, SAMPLES + 1)[1:]
    times = np.sort(np.append(grid, [e.time for e in inside if e.time < horizon]))
    times = apart_from(judge, times)
    errors = state_errors(judge, history, times)
    misplaced = event_errors(problem, judge, inside, found, horizon)
    allowed = 1e-10 + 100 * EPSILON * judge.growth_at(np.append(times, misplaced[0]))
    errors = np.append(errors, misplaced[1])
    stated = history.missed_penetration or 0.0
    open_question = difference is not None and undecidable(problem, judge, difference, stated)
    return Verdict(
        events=len(inside),
        difference=difference,
        undecidable=open_question,
        error=float(errors.max(initial=0.0)),
        excess=float((errors / allowed).max(initial=0.0)),
        energy=history.energy_residual(),
        growth=judge.growth,
    )


def apart_from(judge: Judge, times: Array) -> Array:
    """Return the instants at which velocities do not jump, and no rebounds come to their end."""
    tails = [(t.start, t.end) for t in judge.tails]
    jump = [e.time for e in judge.events if e.before == e.after or RESTING in e.states]
    kept = np.ones(times.size, bool)
    for start, end in tails + [(time, time) for time in jump]:
        room = judge.end * max(EDGE, 1e4 * EPSILON * judge.growth)
        kept &= (times < start - room) | (times > end + room)
    return times[kept]


def between_events(judge: Judge, end: float) -> Array:
    """Return the start and the middle of each stretch without events, up to an end."""
    switches = [0.0, *(event.time for event in judge.events if event.time < end), end]
    return np.array([0.0, *(0.5 * (a + b) for a, b in pairwise(switches))])


def state_errors(judge: Judge, history: "History", times: Array) -> Array:
    """Return the error of the states at each time, relative to the largest up to then."""
    errors = np.zeros(times.size)
    if times.size == 0:
        return errors
    largest = judge.motion(between_events(judge, times[-1]))
    for derivative, wanted in enumerate(judge.motion(times)):
        size = max(np.abs(wanted).max(), np.abs(largest[derivative]).max()) or 1.0
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
    """Return instants at which laws close, open or meet a break, and how far off the core is then.

    That is the time between the two events times the speed, relative to the largest excursion:
    the instant of a graze is blurred, its place is not.
    """
    times, late, rows = [], [], []
    for number, law in enumerate(problem.laws):
        lists = (by_stop(e, number, 1e-12 * judge.end, judge.tails) for e in (expected, found))
        for a, b in zip(*lists, strict=False):
            is_placed = OPEN in a.states or isinstance(law, Spring)
            if (
                a.time < horizon
                and is_placed
                and a.before != RESTING
                and not in_tail(a, judge.tails)
            ):
                times.append(a.time)
                late.append(abs(a.time - b.time))
                rows.append(law.coordinates[0][0])
    if not times:
        return np.zeros(0), np.zeros(0)
    grid = np.linspace(0.0, horizon, SAMPLES + 1)
    displacement = judge.motion(np.append(grid, between_events(judge, horizon)))[0]
    reach = (np.abs(displacement).max() or 1.0) * np.abs(rows).sum(axis=1)
    velocity = judge.motion(np.array(times))[1]
    speed = np.abs((velocity * rows).sum(axis=1))
    return np.array(times), np.array(late) * speed / reach
