"""Fifty-digit judge of several stops and soft laws: Taylor series in decimal arithmetic.

The series of the motion follows from the equation of motion term by term, so that it needs
neither eigenvalues nor matrix exponentials; that of each load is written down at the step's start.
"""

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal, localcontext
from itertools import count, islice
from math import comb

import numpy as np
from mpmath import mp

from ..precise import DIGITS, RADIUS, Step, Vector, decimals, dot, first_root
from ..problem import Array
from .impacts import Tail
from .laws.form import Form
from .laws.law import Law
from .loads import Harmonic, Load, Polynomial, Table
from .problem import SeveralStops
from .scan import Event, Minimum, ScanSolution

ZERO, ONE = Decimal(0), Decimal(1)
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


Terms = Sequence[Vector]
"""Consecutive Taylor coefficients of the modal displacements."""


@dataclass(frozen=True)
class _Law:
    """A law with the rows of its local coordinates in decimals."""

    law: Law
    coordinates: list[tuple[Vector, Decimal]]

    @classmethod
    def of(cls, law: Law) -> "_Law":
        return cls(law, [(decimals(row), Decimal(offset)) for row, offset in law.coordinates])

    def coefficient(
        self, form: Form[Decimal], terms: Terms, n: int, h: Decimal, memory: Decimal
    ) -> Decimal:
        """Return one coefficient of a function, from those of the motion from the n-th on."""
        total = form.constant + form.memory * memory if n == 0 else ZERO
        for (number, order), factor in form.factors.items():
            row, offset = self.coordinates[number]
            value = dot(row, terms[order])
            for k in range(order):
                value *= (n + k + 1) / h
            if n == 0 and order == 0:
                value += offset
            total += factor * value
        return total

    def size(self, form: Form[Decimal], reach: Vector, h: Decimal, memory: Decimal) -> Decimal:
        """Return the sizes that a function is the sum of over a step."""
        total = abs(form.constant) + abs(form.memory * memory)
        for (number, order), factor in form.factors.items():
            row, offset = self.coordinates[number]
            value = dot([abs(a) for a in row], reach) / h**order
            total += abs(factor) * (value + (abs(offset) if order == 0 else ZERO))
        return total


class PreciseSeveral:
    """The motion of one problem with its switches, to about 45 digits, up to so many events."""

    def __init__(self, problem: SeveralStops, most_events: int, largest_growth: float) -> None:
        """Solve, up to where the scan in double precision finds that perturbations have grown."""
        scan = ScanSolution(problem, largest_growth)
        self.growth, self.growth_at = scan.growth, scan.growth_at
        self.end, self.most_events = scan.end, most_events
        self.events: list[Event] = []
        self.minima: list[Minimum] = []
        self.tails: list[Tail] = []
        self.steps: list[Step] = []
        with localcontext(prec=DIGITS):
            self._read(problem)
            self._solve()

    def _read(self, problem: SeveralStops) -> None:
        self.loads = [(decimals(load.shape), load) for load in problem.loads]
        self.omega2, self.damping = decimals(problem.omega2), decimals(problem.damping)
        self.force = decimals(problem.force)
        self.laws = [_Law.of(law) for law in problem.laws]
        self.memories = [ZERO] * len(self.laws)
        self.coupling: list[Vector] | None = None
        if problem.coupling is not None:
            self.coupling = [decimals(row) for row in problem.coupling]
        self.start = decimals(problem.displacement), decimals(problem.velocity)
        knots = {float(t) for _, a in self.loads if isinstance(a, Table) for t in a.times}
        self.knots = [Decimal(t) for t in sorted({*knots, self.end}) if 0.0 < t <= self.end]

    # -- one step --------------------------------------------------------------------------

    def _length(self, states: tuple[str, ...]) -> Decimal:
        stiffness, damping = max(self.omega2), max(self.damping)
        for law, state in zip(self.laws, states, strict=True):
            for (row, _), form in zip(law.coordinates, law.law.forces(state, ONE), strict=False):
                for (number, order), factor in form.factors.items():
                    felt = law.coordinates[number][0]
                    pull = abs(factor) * (dot(row, row) * dot(felt, felt)).sqrt()
                    stiffness += pull if order == 0 else ZERO
                    damping += pull if order == 1 else ZERO
        for row in self.coupling or []:
            damping += max(abs(a) for a in row)
        for _, load in self.loads:
            if isinstance(load, Harmonic):
                stiffness = max(stiffness, Decimal(load.frequency) ** 2)
        rate = (damping + (damping * damping + 4 * stiffness).sqrt()) / 2
        rate = max(rate, 1 / Decimal(self.end))
        return Decimal(RADIUS) / rate

    def _terms(
        self, states: tuple[str, ...], time: Decimal, q: Vector, v: Vector, h: Decimal
    ) -> Iterator[Vector]:
        """Yield the coefficients of the modal displacements."""
        now, following, force = q, [a * h for a in v], self.force
        acting = [
            (law, row, form, memory)
            for law, state, memory in zip(self.laws, states, self.memories, strict=True)
            for (row, _), form in zip(law.coordinates, law.law.forces(state, ONE), strict=False)
        ]
        loads = [(shape, load_series(load, time, h)) for shape, load in self.loads]
        for n in count():
            yield now
            push = list(force)
            for shape, series in loads:
                value = next(series)
                push = [p + s * value for p, s in zip(push, shape, strict=True)]
            for law, row, form, memory in acting:
                value = law.coefficient(form, (now, following), n, h, memory)
                push = [p + s * value for p, s in zip(push, row, strict=True)]
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
        self, states: tuple[str, ...], time: Decimal, q: Vector, v: Vector, h: Decimal
    ) -> list[Vector]:
        """Return the terms down to the precision, three small ones in a row ending them."""
        series: list[Vector] = []
        size, small = ZERO, 0
        for term in islice(self._terms(states, time, q, v, h), MOST_TERMS):
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
        """Yield law, state that is tried, polynomial and the sizes it is the sum of."""
        reach = [max(abs(a) for a in mode) for mode in zip(*series, strict=True)]
        both = zip(self.laws, states, self.memories, strict=True)
        for number, (law, state, memory) in enumerate(both):
            for tried, form in law.law.guards(state, ONE):
                size = law.size(form, reach, h, memory)
                if size == 0:
                    continue
                highest = max(order for _, order in form.factors)
                count = len(series) - highest
                pieces = (series[n : n + highest + 1] for n in range(count))
                guard = [
                    law.coefficient(form, terms, n, h, memory) for n, terms in enumerate(pieces)
                ]
                yield number, tried, guard, size

    # -- the run ---------------------------------------------------------------------------

    def _first_states(self, q: Vector, v: Vector) -> tuple[str, ...]:
        states = []
        for number, law in enumerate(self.laws):

            def value(form: Form[Decimal], law: _Law = law) -> Decimal:
                return law.coefficient(form, (q, v), 0, ONE, ZERO)

            state = law.law.start(value, ONE)
            remembered = law.law.memory("", state, state, ONE)
            if remembered is not None:
                self.memories[number] = value(remembered)
            states.append(state)
        return tuple(states)

    def _switch(
        self, states: tuple[str, ...], number: int, tried: str, time: Decimal, q: Vector, v: Vector
    ) -> tuple[str, ...]:
        """Let a law go over to its next state."""
        law, before = self.laws[number], states[number]
        h = self._length(states)
        scale = [max(abs(a), abs(h * b)) for a, b in zip(q, v, strict=True)]

        def going_on(state: str) -> tuple[str, ...]:
            return (*states[:number], state, *states[number + 1 :])

        def sign(state: str, form: Form[Decimal]) -> int:
            terms = list(islice(self._terms(going_on(state), time, q, v, h), 3))
            value = law.coefficient(form, terms, 0, h, self.memories[number])
            zero = TOUCHING * law.size(form, scale, h, self.memories[number])
            return 0 if abs(value) <= zero else 1 if value > 0 else -1

        after = law.law.follow(before, tried, sign, ONE)
        remembered = law.law.memory(before, tried, after, ONE)
        if remembered is not None:
            memory = self.memories[number]
            self.memories[number] = law.coefficient(remembered, (q, v), 0, ONE, memory)
        if time > 0:
            self.events.append(Event(float(time), number, before, after))
        return going_on(after)

    def _solve(self) -> None:
        q, v = self.start
        states, time, at_once = self._first_states(q, v), ZERO, 0
        begins = True
        end = Decimal(self.end)
        while time < end and len(self.events) < self.most_events:
            h = self._length(states)
            series = self._series(states, time, q, v, h)
            knot = next(t for t in self.knots if t > time)
            room = min(Decimal(1), (knot - time) / h)
            part, event = self._first_event(states, series, h, time, room, begins)
            self.steps.append(Step("", time, h, part, series))
            following = knot if event is None and part < 1 else time + part * h
            q, v = self.steps[-1].at(following)
            begins = event is not None
            if event is not None:
                states = self._switch(states, *event, following, q, v)
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
        for number, tried, guard, size in self._guards(states, series, h):
            inside = departing(guard, size) if begins else guard
            if not inside:
                continue
            if inside[0] <= 0:
                return ZERO, (number, tried)
            # Over the whole step: an end that is itself a root would be no bracket.
            root, least = first_root(inside, room)
            if least is not None:
                self.minima.append(Minimum(float(time), number, float(abs(least) / size)))
            if root is not None and root < end:
                end, event = root, (number, tried)
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
