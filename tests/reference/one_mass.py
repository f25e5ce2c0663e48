"""One mass among stops, at fifty digits and in closed form.

Between two switches its motion, and with it every guard, is a constant plus a decaying
oscillation, two exponentials, or a parabola. The instants at which such a function turns are
known, so that each of its roots is bracketed between two of them: nothing is scanned.
"""

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count

import numpy as np
from mpmath import mp, mpf

from .problem import CLOSED, OPEN, RELEASED, Array
from .several.problem import SeveralStops, Stop
from .several.scan import Event

DIGITS = 50
NOTHING = mpf(10) ** -38  # relative: what is smaller is rounding
MOST_EVENTS = 20_000


@dataclass(frozen=True)
class Wall:
    """A stop at distance ``d = gap + side x``; the side is that along which it pushes, 1 or -1."""

    side: int
    gap: float
    stiffness: float
    damping: float = 0.0


@dataclass(frozen=True)
class Mass:
    """``x'' + damping x' + omega2 x = force`` and the pushes of walls."""

    walls: tuple[Wall, ...]
    duration: float
    displacement: float = 0.0
    velocity: float = 0.0
    force: float = 0.0
    omega2: float = 0.0
    damping: float = 0.0

    def several(self) -> SeveralStops:
        """Return the same as modal arrays."""
        one = np.ones(1)
        return SeveralStops(
            omega2=self.omega2 * one,
            damping=self.damping * one,
            stops=tuple(Stop(w.side * one, w.gap, w.stiffness, w.damping) for w in self.walls),
            duration=self.duration,
            displacement=self.displacement * one,
            velocity=self.velocity * one,
            force=self.force * one,
        )


@dataclass(frozen=True)
class Curve:
    """``rest + slope t + bend t^2 / 2 + a e^(r t) + b e^(s t)``; r and s may be conjugate."""

    rest: mpf
    slope: mpf
    bend: mpf
    rates: tuple[mpf, mpf]
    factors: tuple[mpf, mpf]

    @classmethod
    def of(cls, stiffness: mpf, damping: mpf, force: mpf, x: mpf, v: mpf) -> "Curve":
        """Solve ``x'' + damping x' + stiffness x = force`` from x and v."""
        none = (mpf(0), mpf(0))
        if stiffness == 0:
            assert damping == 0, "a free mass has no drag here"
            return cls(x, v, force, none, none)
        root = mp.sqrt(mp.mpc(damping**2 / 4 - stiffness))
        assert root != 0, "not for critical damping"
        r, s = -damping / 2 + root, -damping / 2 - root
        y = x - force / stiffness
        a, b = (v - s * y) / (r - s), (r * y - v) / (r - s)
        return cls(force / stiffness, mpf(0), mpf(0), (r, s), (a, b))

    def at(self, t: mpf, order: int = 0) -> mpf:
        """Return a derivative."""
        smooth = (self.rest + t * (self.slope + t * self.bend / 2), self.slope + t * self.bend)
        value = (*smooth, self.bend, mpf(0))[order]
        for rate, factor in zip(self.rates, self.factors, strict=True):
            value += mp.re(factor * rate**order * mp.exp(rate * t))
        return value

    def guard(self, constant: mpf, position: mpf, rate: mpf) -> "Curve":
        """Return ``constant + position x + rate x'`` along this motion."""
        factors = [f * (position + rate * r) for f, r in zip(self.factors, self.rates, strict=True)]
        return Curve(
            rest=constant + position * self.rest + rate * self.slope,
            slope=position * self.slope + rate * self.bend,
            bend=position * self.bend,
            rates=self.rates,
            factors=(factors[0], factors[1]),
        )

    def turns(self) -> Iterator[mpf]:
        """Yield the times after zero at which the slope vanishes."""
        (r, s), (a, b) = self.rates, self.factors
        if r == 0:
            if self.bend != 0 and -self.slope / self.bend > 0:
                yield -self.slope / self.bend
        elif mp.im(r) != 0:
            # Twice the real part of (a r e^(r t)) vanishes where its argument is pi / 2.
            frequency, start = mp.im(r), mp.arg(a * r)
            for n in count(-2):
                time = ((n + mpf(1) / 2) * mp.pi - start) / frequency
                if time > 0:
                    yield time
        elif b != 0 and mp.re(-a * r / (b * s)) > 0:
            time = mp.log(mp.re(-a * r / (b * s))) / mp.re(s - r)
            if time > 0:
                yield time

    def fall(self, limit: mpf, size: mpf) -> mpf | None:
        """Return the first time, if any, at which this falls below zero; it may start there."""
        small = [NOTHING * size * max(1, abs(self.rates[0])) ** n for n in range(4)]
        start = [self.at(mpf(0), order) for order in range(4)]
        leading = next((d for d, e in zip(start, small, strict=True) if abs(d) > e), mpf(0))
        if leading < 0:
            return mpf(0)
        if leading == 0:
            return None
        left = mpf(0)
        for turn in self.turns():
            right = min(turn, limit)
            if self.at(right) < -small[0]:
                return self.root(left, right)
            if right == limit:
                return None
            left = right
        return self.root(left, limit) if self.at(limit) < -small[0] else None

    def root(self, left: mpf, right: mpf) -> mpf:
        """Return the root of a stretch over which this falls, by Newton's method in a bracket."""
        t = (left + right) / 2
        for _ in range(400):
            value, slope = self.at(t), self.at(t, 1)
            left, right = (t, right) if value > 0 else (left, t)
            new = t - value / slope if slope != 0 else left
            if not left < new < right:
                new = (left + right) / 2
            if abs(new - t) <= abs(new) * mpf(10) ** (5 - DIGITS):
                return new
            t = new
        raise ArithmeticError("no convergence inside the bracket")


def guards(wall: Wall, state: str, motion: Curve) -> dict[str, Curve]:
    """Return what stays positive as long as a stop stays in its state, by the state after."""
    gap, side = mpf(wall.gap), mpf(wall.side)
    hold = side * mpf(wall.damping) / mpf(wall.stiffness)
    if state == OPEN:
        return {CLOSED: motion.guard(gap, side, mpf(0))}
    if state == CLOSED:
        return {RELEASED if wall.damping > 0 else OPEN: motion.guard(-gap, -side, -hold)}
    return {OPEN: motion.guard(-gap, -side, mpf(0)), CLOSED: motion.guard(gap, side, hold)}


@dataclass(frozen=True)
class Phase:
    """A stretch in which nothing switches."""

    start: mpf
    motion: Curve


class OneMass:
    """The motion of a mass among walls, and all its events."""

    def __init__(self, mass: Mass) -> None:
        """Solve."""
        self.mass = mass
        self.phases: list[Phase] = []
        self.events: list[Event] = []
        with mp.workdps(DIGITS):
            self._solve()

    def _solve(self) -> None:
        x, v, time = mpf(self.mass.displacement), mpf(self.mass.velocity), mpf(0)
        states = [self._first_state(wall, x, v) for wall in self.mass.walls]
        for _ in range(MOST_EVENTS):
            motion = self._motion(states, x, v)
            self.phases.append(Phase(time, motion))
            found = self._next(states, motion, self.mass.duration - time)
            if found is None:
                return
            span, stop, after = found
            time, x, v = time + span, motion.at(span), motion.at(span, 1)
            if time > 0:  # at the start it only says what the first state is
                self.events.append(Event(float(time), stop, states[stop], after))
            states[stop] = after
        raise ArithmeticError("more events than expected")

    def _first_state(self, wall: Wall, x: mpf, v: mpf) -> str:
        distance, rate = wall.gap + wall.side * x, wall.side * v
        if distance >= 0:
            return OPEN  # one that touches switches at once if it must
        return CLOSED if -wall.stiffness * distance - wall.damping * rate > 0 else RELEASED

    def _motion(self, states: list[str], x: mpf, v: mpf) -> Curve:
        stiffness, damping = mpf(self.mass.omega2), mpf(self.mass.damping)
        force = mpf(self.mass.force)
        for wall, state in zip(self.mass.walls, states, strict=True):
            if state == CLOSED:
                stiffness += mpf(wall.stiffness)
                damping += mpf(wall.damping)
                force -= wall.side * mpf(wall.stiffness) * mpf(wall.gap)
        return Curve.of(stiffness, damping, force, x, v)

    def _next(self, states: list[str], motion: Curve, limit: mpf) -> tuple[mpf, int, str] | None:
        """Return when which stop goes over to what, the earliest of all."""
        reach = abs(motion.at(mpf(0))) + abs(motion.at(mpf(0), 1)) + abs(motion.rest)
        reach += sum(abs(factor) for factor in motion.factors)
        first: tuple[mpf, int, str] | None = None
        # The stiffest that pushes comes first: its switch is near, and ends the search of others.
        walls = self.mass.walls
        order = sorted(range(len(walls)), key=lambda n: (states[n] == OPEN, -walls[n].stiffness))
        for number in order:
            wall = walls[number]
            for after, guard in guards(wall, states[number], motion).items():
                span = guard.fall(limit, reach + abs(wall.gap))
                if span is not None:
                    first, limit = (span, number, after), span
        return first

    def motion(self, times: Array) -> tuple[Array, Array]:
        """Return displacement and velocity, each (time, 1)."""
        starts = [phase.start for phase in self.phases]
        found = np.empty((2, times.size, 1))
        with mp.workdps(DIGITS):
            for i, time in enumerate(times.tolist()):
                phase = self.phases[max(bisect_right(starts, mpf(time)) - 1, 0)]
                for order in (0, 1):
                    found[order, i] = float(phase.motion.at(mpf(time) - phase.start, order))
        return found[0], found[1]
