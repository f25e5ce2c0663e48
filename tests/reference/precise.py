"""Fifty-digit oracle: Taylor series of the motion, phase by phase, in decimal arithmetic.

Inside a phase the motion is the exponential of a constant matrix applied to the state. Its power
series follows from the equation of motion itself, term by term, so that neither eigenvalues nor
an eigenvalue solver enter: rigid, repeated, critically damped and overdamped modes need nothing
special. Events are found by sampling every guard at a hundredth of the fastest rate, refining
each local minimum, and bracketing each root to full precision.
"""

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal, localcontext
from itertools import islice, pairwise

import numpy as np

from .problem import CLOSED, OPEN, RELEASED, Array, StopProblem

DIGITS = 50
RADIUS = 2.0  # rate bound times step: the terms of the series then lose no more than e^2
SAMPLES = 34  # over two radians: a hundredth of the shortest period

Vector = list[Decimal]
ZERO = Decimal(0)


def decimals(values: Array) -> Vector:
    """Convert exactly: each double is a finite decimal."""
    return [Decimal(float(value)) for value in values]


def dot(left: Vector, right: Vector) -> Decimal:
    """Return the scalar product."""
    return sum((a * b for a, b in zip(left, right, strict=True)), ZERO)


@dataclass(frozen=True)
class Switch:
    """A change of state."""

    time: Decimal
    before: str
    after: str


@dataclass(frozen=True)
class Step:
    """Series of the motion in ``s = (t - start) / length``, valid for s in [0, end]."""

    state: str
    start: Decimal
    length: Decimal
    end: Decimal
    motion: list[Vector]

    def at(self, time: Decimal) -> tuple[Vector, Vector]:
        """Return displacement and velocity."""
        s = (time - self.start) / self.length
        modes = len(self.motion[0])
        displacement, velocity = [ZERO] * modes, [ZERO] * modes
        for term in reversed(self.motion):
            velocity = [v * s + q for v, q in zip(velocity, displacement, strict=True)]
            displacement = [q * s + a for q, a in zip(displacement, term, strict=True)]
        return displacement, [v / self.length for v in velocity]


def polynomial(coefficients: Vector, s: Decimal) -> tuple[Decimal, Decimal]:
    """Return the value and the derivative at s."""
    value, slope = ZERO, ZERO
    for coefficient in reversed(coefficients):
        slope = slope * s + value
        value = value * s + coefficient
    return value, slope


def derivative(coefficients: Vector) -> Vector:
    """Return the coefficients of the derivative."""
    return [n * a for n, a in enumerate(coefficients)][1:]


def bracketed_root(coefficients: Vector, left: Decimal, right: Decimal) -> Decimal:
    """Newton's method kept inside a bracket over which the polynomial changes its sign."""
    rising = polynomial(coefficients, right)[0] > 0
    s = (left + right) / 2
    for _ in range(400):
        value, slope = polynomial(coefficients, s)
        if value == 0:
            return s
        left, right = (left, s) if (value > 0) == rising else (s, right)
        new = s - value / slope if slope != 0 else left
        if not left < new < right:
            new = (left + right) / 2
        if abs(new - s) < Decimal(10) ** (4 - DIGITS):
            return new
        s = new
    raise ArithmeticError("no convergence inside the bracket")


def first_root(guard: Vector, end: Decimal) -> tuple[Decimal | None, Decimal | None]:
    """Return where a guard, positive at s = 0+, first falls below zero, and its least minimum."""
    coefficients = np.array([float(a) for a in guard])
    s = np.linspace(0.0, float(end), SAMPLES + 1)
    values = np.polynomial.polynomial.polyval(s, coefficients)
    slopes = np.polynomial.polynomial.polyval(s, np.polynomial.polynomial.polyder(coefficients))
    assert guard[0] > 0, "a phase must start inside its guards"
    below = values[1:] <= 0.0
    minimum = (slopes[:-1] < 0.0) & (slopes[1:] >= 0.0)
    least = None
    for cell in np.flatnonzero(below | minimum):
        left, right = Decimal(float(s[cell])), Decimal(float(s[cell + 1]))
        if minimum[cell]:
            lowest = bracketed_root(derivative(guard), left, right)
            value = polynomial(guard, lowest)[0]
            least = value if least is None else min(least, value, key=abs)
            if value <= 0:
                return bracketed_root(guard, left, lowest), least
        if below[cell]:
            return bracketed_root(guard, left, right), least
    return None, least


class PreciseSolution:
    """The whole motion of one problem, with its switches, to about 45 digits."""

    def __init__(self, problem: StopProblem, nudge: Array | None = None) -> None:
        """Solve. ``nudge`` (2N,) is added to the initial state, times 1e-25."""
        with localcontext(prec=DIGITS):
            self._read(problem)
            q, v = decimals(problem.displacement), decimals(problem.velocity)
            if nudge is not None:
                tiny = [d.scaleb(-25) for d in decimals(nudge)]
                q = [a + b for a, b in zip(q, tiny[: len(q)], strict=True)]
                v = [a + b for a, b in zip(v, tiny[len(q) :], strict=True)]
            self._solve(q, v)

    def _read(self, problem: StopProblem) -> None:
        self.problem = problem
        self.omega2, self.damping = decimals(problem.omega2), decimals(problem.damping)
        self.row, self.force = decimals(problem.row), decimals(problem.force)
        self.gap, self.stiffness = Decimal(problem.gap), Decimal(problem.stiffness)
        self.stop_damping = Decimal(problem.stop_damping)
        self.duration = Decimal(problem.duration)
        self.steps: list[Step] = []
        self.switches: list[Switch] = []
        self.margin = Decimal("inf")  # nearest approach of a guard's minimum to zero, relative

    # -- one phase -------------------------------------------------------------------------

    def _step_length(self, state: str) -> Decimal:
        k, c = (self.stiffness, self.stop_damping) if state == CLOSED else (ZERO, ZERO)
        norm = dot(self.row, self.row)
        stiffness, damping = max(self.omega2) + k * norm, max(self.damping) + c * norm
        rate = (damping + (damping * damping + 4 * stiffness).sqrt()) / 2
        return min(Decimal(RADIUS) / rate, self.duration) if rate > 0 else self.duration

    def _terms(self, state: str, q: Vector, v: Vector, h: Decimal) -> Iterator[Vector]:
        """Yield the coefficients of the series of the modal displacements."""
        now, following = q, [a * h for a in v]
        h2, n = h * h, 0
        while True:
            yield now
            contact = self._trial(now, following, n, h) if state == CLOSED else ZERO
            scale = h2 / ((n + 1) * (n + 2))
            rate = (n + 1) / h
            load = self.force if n == 0 else [ZERO] * len(q)
            now, following = (
                following,
                [
                    scale * (p - c * rate * b - w * a + f * contact)
                    for p, c, b, w, a, f in zip(
                        load, self.damping, following, self.omega2, now, self.row, strict=True
                    )
                ],
            )
            n += 1

    def _distance(self, term: Vector, n: int) -> Decimal:
        return dot(self.row, term) + (self.gap if n == 0 else ZERO)

    def _trial(self, term: Vector, following: Vector, n: int, h: Decimal) -> Decimal:
        """Return one coefficient of ``-k d - c d'``, the force if it were closed."""
        rate = (n + 1) / h * dot(self.row, following)
        return -self.stiffness * self._distance(term, n) - self.stop_damping * rate

    def _series(self, state: str, q: Vector, v: Vector, h: Decimal) -> list[Vector]:
        """Return the terms down to the precision, two small ones in a row ending them."""
        series = list(islice(self._terms(state, q, v, h), 8))
        size = max((abs(a) for term in series for a in term), default=ZERO)
        small = 0
        for term in islice(self._terms(state, q, v, h), 8, 400):
            series.append(term)
            top = max(abs(a) for a in term)
            size = max(size, top)
            small = small + 1 if top <= size.scaleb(-DIGITS) else 0
            if small == 2:
                return series
        raise ArithmeticError("the series does not converge")

    def _guards(self, state: str, series: list[Vector], h: Decimal) -> dict[str, Vector]:
        """Return the polynomials that are positive as long as the state lasts, by next state."""
        distance = [self._distance(term, n) for n, term in enumerate(series)]
        trial = [
            self._trial(term, following, n, h)
            for n, (term, following) in enumerate(pairwise(series))
        ]
        if state == OPEN:
            return {CLOSED: distance}
        if state == CLOSED:
            return {RELEASED if self.stop_damping > 0 else OPEN: trial}
        return {OPEN: [-a for a in distance], CLOSED: [-a for a in trial]}

    # -- the run ---------------------------------------------------------------------------

    def _first_state(self, q: Vector, v: Vector) -> tuple[str, bool, bool]:
        """Return the state at the start and whether distance and trial force are exactly zero."""
        h = self._step_length(OPEN)
        series = self._series(OPEN, q, v, h)
        distance = [self._distance(term, n) for n, term in enumerate(series)]
        trial = self._trial(series[0], series[1], 0, h)
        if distance[0] > 0:
            return OPEN, False, False
        if distance[0] == 0:
            leading = next((a for a in distance if a != 0), ZERO)
            return CLOSED if leading < 0 else OPEN, True, trial == 0
        if trial != 0:
            return CLOSED if trial > 0 else RELEASED, False, False
        raise NotImplementedError("a start below the stop with exactly zero force")

    def _solve(self, q: Vector, v: Vector) -> None:
        time = ZERO
        state, touching, forceless = self._first_state(q, v)
        rounding = self.duration.scaleb(5 - DIGITS)
        while self.duration - time > rounding:
            step, after = self._advance(state, time, q, v, touching, forceless)
            self.steps.append(step)
            time = step.start + step.end * step.length
            q, v = step.at(time)
            touching = forceless = False
            if after is not None:
                self.switches.append(Switch(time, state, after))
                # What has just passed through zero is zero, whatever the last digit says.
                by_distance = OPEN in (state, after)
                touching = by_distance or self.stop_damping == 0
                forceless = not by_distance or self.stop_damping == 0
                state = after

    def _advance(
        self, state: str, time: Decimal, q: Vector, v: Vector, touching: bool, forceless: bool
    ) -> tuple[Step, str | None]:
        """Return the next step and, if a guard fell through zero in it, the state that follows."""
        h = self._step_length(state)
        series = self._series(state, q, v, h)
        end, after = min(Decimal(1), (self.duration - time) / h), None
        for following, guard in self._guards(state, series, h).items():
            zero = touching if OPEN in (state, following) else forceless
            size = max(abs(a) for a in guard)
            inside = deflated(guard, zero)
            if not inside:
                continue
            root, least = first_root(inside, end)
            if least is not None:
                self.margin = min(self.margin, abs(least) / size)
            if root is not None:
                end, after = root, following
        return Step(state, time, h, end, series), after

    # -- what came out ---------------------------------------------------------------------

    def step_at(self, time: float | Decimal) -> Step:
        """Return the step that holds a time."""
        index = bisect_right(self.steps, Decimal(time), key=lambda step: step.start)
        return self.steps[max(index - 1, 0)]

    def exact_state(self, time: float | Decimal) -> tuple[Vector, Vector]:
        """Return displacement and velocity as decimals."""
        with localcontext(prec=DIGITS):
            return self.step_at(time).at(Decimal(time))

    def motion(self, times: Array) -> tuple[Array, Array]:
        """Return displacement and velocity, each (time, mode)."""
        states = [self.exact_state(float(time)) for time in times]
        displacement = np.array([[float(a) for a in q] for q, _ in states])
        return displacement, np.array([[float(a) for a in v] for _, v in states])

    def contact(self, times: Array) -> tuple[Array, Array]:
        """Return distance and force, each (time,)."""
        p = self.problem
        displacement, velocity = self.motion(times)
        distance = p.gap + displacement @ p.row
        closed = np.array([self.step_at(float(t)).state == CLOSED for t in times])
        trial = -p.stiffness * distance - p.stop_damping * (velocity @ p.row)
        return distance, np.where(closed, trial, 0.0)

    @property
    def events(self) -> list[tuple[float, str, str]]:
        """Times with the states before and after, rounded to doubles."""
        return [(float(s.time), s.before, s.after) for s in self.switches]


def deflated(guard: Vector, zero: bool) -> Vector:
    """Divide out the roots at s = 0, which the phase starts on; empty where nothing is left."""
    rest = guard[1:] if zero else guard
    if zero or rest[0] == 0:
        while rest and rest[0] == 0:
            rest = rest[1:]
    return rest if any(rest) else []
