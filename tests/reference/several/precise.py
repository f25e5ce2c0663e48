"""Fifty-digit judge of several stops under forces in time: Taylor series in decimal arithmetic.

The series of the motion follows from the equation of motion term by term, so that it needs
neither eigenvalues nor matrix exponentials; that of each load is written down at the step's start.
"""

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal, localcontext
from itertools import count, islice, pairwise
from math import comb

import numpy as np
from mpmath import mp

from ..precise import DIGITS, RADIUS, Step, Vector, decimals, dot, first_root
from ..problem import CLOSED, OPEN, RELEASED, Array
from .loads import Harmonic, Load, Polynomial, Table
from .problem import SeveralStops, Stop
from .scan import Event, Minimum, ScanSolution

ZERO = Decimal(0)
TOUCHING = Decimal(10) ** (10 - DIGITS)
MOST_TERMS = 400
MOST_AT_ONCE = 64


def load_series(load: Load, time: Decimal, h: Decimal) -> Iterator[Decimal]:
    """Yield the Taylor coefficients of a load over a step of length h from a time."""
    if isinstance(load, Harmonic):
        with mp.workdps(DIGITS + 10):
            angle = mp.mpf(load.frequency) * mp.mpf(str(time)) + mp.mpf(load.phase)
            cos, sin = (Decimal(mp.nstr(f(angle), DIGITS + 5)) for f in (mp.cos, mp.sin))
        scale = Decimal(1)
        for n in count():
            yield scale * (cos, -sin, -cos, sin)[n % 4]
            scale *= Decimal(load.frequency) * h / (n + 1)
    elif isinstance(load, Polynomial):
        a = [Decimal(c) for c in load.coefficients]
        for n in range(len(a)):
            value = ZERO
            for k in range(len(a) - 1, n - 1, -1):
                value = value * time + comb(k, n) * a[k]
            yield h**n * value
    else:
        times, values = decimals(load.times), decimals(load.values)
        at = bisect_right(times, time) - 1
        if at < 0 or at + 1 == len(times):
            yield values[max(at, 0)] if load.holds else ZERO
        else:
            slope = (values[at + 1] - values[at]) / (times[at + 1] - times[at])
            yield values[at] + slope * (time - times[at])
            yield h * slope
    while True:
        yield ZERO


@dataclass(frozen=True)
class _Stop:
    """A stop in decimals."""

    row: Vector
    gap: Decimal
    stiffness: Decimal
    damping: Decimal

    @classmethod
    def of(cls, stop: Stop) -> "_Stop":
        numbers = (Decimal(stop.gap), Decimal(stop.stiffness), Decimal(stop.damping))
        return cls(decimals(stop.row), *numbers)

    def distance(self, term: Vector, n: int) -> Decimal:
        """Return one coefficient of the distance."""
        return dot(self.row, term) + (self.gap if n == 0 else ZERO)

    def push(self, term: Vector, following: Vector, n: int, h: Decimal) -> Decimal:
        """Return one coefficient of the force that it has if it is closed, over the stiffness."""
        rate = (n + 1) / h * dot(self.row, following)
        return -self.distance(term, n) - self.damping / self.stiffness * rate


class PreciseSeveral:
    """The motion of one problem with its switches, to about 45 digits, up to so many events."""

    def __init__(self, problem: SeveralStops, most_events: int, largest_growth: float) -> None:
        """Solve, up to where the scan in double precision finds that perturbations have grown."""
        scan = ScanSolution(problem, largest_growth)
        self.growth, self.growth_at = scan.growth, scan.growth_at
        self.end, self.most_events = scan.end, most_events
        self.events: list[Event] = []
        self.minima: list[Minimum] = []
        self.steps: list[Step] = []
        with localcontext(prec=DIGITS):
            self._read(problem)
            self._solve()

    def _read(self, problem: SeveralStops) -> None:
        self.loads = [(decimals(load.shape), load) for load in problem.loads]
        self.omega2, self.damping = decimals(problem.omega2), decimals(problem.damping)
        self.force = decimals(problem.force)
        self.stops = [_Stop.of(stop) for stop in problem.stops]
        self.coupling: list[Vector] | None = None
        if problem.coupling is not None:
            self.coupling = [decimals(row) for row in problem.coupling]
        self.start = decimals(problem.displacement), decimals(problem.velocity)
        knots = {float(t) for _, a in self.loads if isinstance(a, Table) for t in a.times}
        self.knots = [Decimal(t) for t in sorted({*knots, self.end}) if 0.0 < t <= self.end]

    # -- one step --------------------------------------------------------------------------

    def _length(self, closed: list[_Stop]) -> Decimal:
        stiffness, damping = max(self.omega2), max(self.damping)
        for stop in closed:
            norm = dot(stop.row, stop.row)
            stiffness, damping = stiffness + stop.stiffness * norm, damping + stop.damping * norm
        for row in self.coupling or []:
            damping += max(abs(a) for a in row)
        for _, load in self.loads:
            if isinstance(load, Harmonic):
                stiffness = max(stiffness, Decimal(load.frequency) ** 2)
        rate = (damping + (damping * damping + 4 * stiffness).sqrt()) / 2
        rate = max(rate, 1 / Decimal(self.end))
        return Decimal(RADIUS) / rate

    def _terms(
        self, closed: list[_Stop], time: Decimal, q: Vector, v: Vector, h: Decimal
    ) -> Iterator[Vector]:
        """Yield the coefficients of the modal displacements."""
        now, following, force = q, [a * h for a in v], self.force
        loads = [(shape, load_series(load, time, h)) for shape, load in self.loads]
        for n in count():
            yield now
            push = list(force)
            for shape, series in loads:
                value = next(series)
                push = [p + s * value for p, s in zip(push, shape, strict=True)]
            for stop in closed:
                value = stop.stiffness * stop.push(now, following, n, h)
                push = [p + s * value for p, s in zip(push, stop.row, strict=True)]
            rate = (n + 1) / h
            drag = [c * rate * b for c, b in zip(self.damping, following, strict=True)]
            if self.coupling is not None:
                more = (rate * dot(row, following) for row in self.coupling)
                drag = [a + b for a, b in zip(drag, more, strict=True)]
            scale = h * h / ((n + 1) * (n + 2))
            now, following = (
                following,
                [
                    scale * (p - c - w * a)
                    for p, c, w, a in zip(push, drag, self.omega2, now, strict=True)
                ],
            )
            force = [ZERO] * len(q)

    def _series(
        self, closed: list[_Stop], time: Decimal, q: Vector, v: Vector, h: Decimal
    ) -> list[Vector]:
        """Return the terms down to the precision, three small ones in a row ending them."""
        series: list[Vector] = []
        size, small = ZERO, 0
        for term in islice(self._terms(closed, time, q, v, h), MOST_TERMS):
            series.append(term)
            top = max(abs(a) for a in term)
            size = max(size, top)
            small = small + 1 if top <= size.scaleb(-DIGITS) else 0
            if small >= 3 and len(series) > 12:
                return series
        raise ArithmeticError("the series does not converge")

    def _guards(
        self, states: tuple[str, ...], series: list[Vector], h: Decimal
    ) -> Iterator[tuple[int, str, Vector, Decimal]]:
        """Yield stop, state that follows, polynomial and the sizes it is the sum of."""
        reach = [max(abs(a) for a in mode) for mode in zip(*series, strict=True)]
        for number, (stop, state) in enumerate(zip(self.stops, states, strict=True)):
            size = dot([abs(a) for a in stop.row], reach) + abs(stop.gap)
            if size == 0:
                continue
            distance = [stop.distance(term, n) for n, term in enumerate(series)]
            if state == OPEN:
                yield number, CLOSED, distance, size
                continue
            push = [stop.push(*pair, n, h) for n, pair in enumerate(pairwise(series))]
            if state == CLOSED:
                yield number, RELEASED if stop.damping > 0 else OPEN, push, size
            else:
                yield number, OPEN, [-a for a in distance], size
                yield number, CLOSED, [-a for a in push], size

    # -- the run ---------------------------------------------------------------------------

    def _first_states(self, q: Vector, v: Vector) -> tuple[str, ...]:
        states = []
        for stop in self.stops:
            one = Decimal(1)
            push, inside = stop.push(q, v, 0, one), stop.distance(q, 0) < 0
            states.append(OPEN if not inside else CLOSED if push > 0 else RELEASED)
        return tuple(states)

    def _solve(self) -> None:
        q, v = self.start
        states, time, at_once = self._first_states(q, v), ZERO, 0
        begins = True
        end = Decimal(self.end)
        while time < end and len(self.events) < self.most_events:
            closed = [s for s, state in zip(self.stops, states, strict=True) if state == CLOSED]
            h = self._length(closed)
            series = self._series(closed, time, q, v, h)
            knot = next(t for t in self.knots if t > time)
            room = min(Decimal(1), (knot - time) / h)
            part, event = self._first_event(states, series, h, time, room, begins)
            self.steps.append(Step("", time, h, part, series))
            following = knot if event is None and part < 1 else time + part * h
            q, v = self.steps[-1].at(following)
            begins = event is not None
            if event is not None:
                number, after = event
                if following > 0:
                    self.events.append(Event(float(following), number, states[number], after))
                states = (*states[:number], after, *states[number + 1 :])
                at_once = at_once + 1 if following == time else 0
                if at_once > MOST_AT_ONCE:
                    raise ArithmeticError(f"endless switching at {time}")
            time = following
        self.end = min(self.end, float(time))

    def _first_event(
        self,
        states: tuple[str, ...],
        series: list[Vector],
        h: Decimal,
        time: Decimal,
        room: Decimal,
        begins: bool,
    ) -> tuple[Decimal, tuple[int, str] | None]:
        """Return the part of the step that is gone, and which stop switches then, to what."""
        end, event = room, None
        for number, after, guard, size in self._guards(states, series, h):
            inside = departing(guard, size) if begins else guard
            if not inside:
                continue
            if inside[0] <= 0:
                return ZERO, (number, after)
            # Over the whole step: an end that is itself a root would be no bracket.
            root, least = first_root(inside, room)
            if least is not None:
                self.minima.append(Minimum(float(time), number, float(abs(least) / size)))
            if root is not None and root < end:
                end, event = root, (number, after)
        return end, event

    # -- what came out ---------------------------------------------------------------------

    def motion(self, times: Array) -> tuple[Array, Array]:
        """Return displacement and velocity, each (time, mode)."""
        starts = [step.start for step in self.steps]
        with localcontext(prec=DIGITS):
            states = [
                self.steps[max(bisect_right(starts, Decimal(t)) - 1, 0)].at(Decimal(t))
                for t in times.tolist()
            ]
        displacement = np.array([[float(a) for a in q] for q, _ in states])
        return displacement, np.array([[float(a) for a in v] for _, v in states])


def departing(guard: Vector, size: Decimal) -> Vector:
    """Divide out the roots at the start of the step; empty where nothing is left."""
    if abs(guard[0]) > TOUCHING * size:
        return guard
    rest = guard[1:]
    while rest and abs(rest[0]) <= TOUCHING * size:
        rest = rest[1:]
    return rest
