"""Period-one orbits of the piecewise-linear impact oscillator, from their closed forms.

``x'' + 2 a x' + x = b cos(w t)`` below a stop at x = 1, a spring or rigid with restitution
(S. W. Shaw and P. J. Holmes, A periodically forced piecewise linear oscillator, Journal of
Sound and Vibration 90, 1983). An orbit with one impact in a number of periods is a solution of
the conditions that it leaves the stop and comes back where it should; its stability follows from
the product of the state transition matrices along it (and the jump at a rigid impact).
"""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from mpmath import mp, mpf

from .problem import Array

DIGITS = 30


@dataclass(frozen=True)
class Oscillator:
    """Its parameters; ``spring`` is the stop's stiffness, or none where it is rigid."""

    damping: float  # a
    forcing: float  # b
    frequency: float  # w
    spring: float | None = None
    restitution: float = 1.0

    def but(self, **changes: float) -> Self:
        """Return the same with some parameters changed."""
        return replace(self, **changes)

    @property
    def period(self) -> mpf:
        """Return the period of the forcing."""
        return 2 * mp.pi / mpf(self.frequency)


@dataclass(frozen=True)
class Linear:
    """``x'' + 2 a x' + k x = b cos(w t) + p``, solved."""

    a: mpf
    k: mpf
    b: mpf
    w: mpf
    p: mpf

    def steady(self, t: mpf) -> tuple[mpf, mpf]:
        """Return the particular solution and its rate."""
        turning = (
            self.b * mp.exp(mp.mpc(0, self.w * t)) / (self.k - self.w**2 + 2j * self.a * self.w)
        )
        return mp.re(turning) + self.p / self.k, mp.re(1j * self.w * turning)

    def transition(self, t: mpf) -> mp.matrix:
        """Return the matrix that carries small changes of (x, x') over a time."""
        rate = mp.sqrt(mp.mpc(self.k - self.a**2))
        c, s = mp.re(mp.cos(rate * t)), mp.re(mp.sin(rate * t) / rate)
        inner = mp.matrix([[c + self.a * s, s], [-self.k * s, c - self.a * s]])
        return mp.exp(-self.a * t) * inner

    def after(self, start: mpf, x: mpf, v: mpf, t: mpf) -> tuple[mpf, mpf]:
        """Return position and velocity a time t after ``start``, from those there."""
        x0, v0 = self.steady(start)
        x1, v1 = self.steady(start + t)
        free = self.transition(t) * mp.matrix([x - x0, v - v0])
        return x1 + free[0], v1 + free[1]


@dataclass(frozen=True)
class Orbit:
    """One impact in so many periods: the instant of closing, its speed, how long it lasts."""

    oscillator: Oscillator
    periods: int
    start: mpf
    speed: mpf
    contact: mpf
    leaving: mpf
    monodromy: mp.matrix

    @property
    def multipliers(self) -> Array:
        """Return the eigenvalues of the monodromy matrix."""
        trace = self.monodromy[0, 0] + self.monodromy[1, 1]
        root = mp.sqrt(mp.mpc(trace**2 / 4 - mp.det(self.monodromy)))
        return np.sort_complex(np.array([complex(trace / 2 - root), complex(trace / 2 + root)]))

    def is_possible(self, samples: int = 100) -> bool:
        """Whether the mass is below the stop in flight and above it in contact, as assumed."""
        o, rest = self.oscillator, self.periods * self.oscillator.period - self.contact
        parts = [mpf(n) / samples for n in range(1, samples)]
        left = self.start + self.contact
        free = [flight(o).after(left, mpf(1), -self.leaving, part * rest)[0] for part in parts]
        if o.spring is None:
            return bool(max(free) < 1)
        held = flight(o, o.spring)
        pressed = [held.after(self.start, mpf(1), self.speed, p * self.contact)[0] for p in parts]
        return bool(max(free) < 1 < min(pressed))


def flight(oscillator: Oscillator, spring: mpf | float = 0) -> Linear:
    """Return the motion below the stop, or against it."""
    o, k = oscillator, mpf(spring)
    return Linear(mpf(o.damping), 1 + k, mpf(o.forcing), mpf(o.frequency), k)


def elastic_orbit(o: Oscillator, guess: tuple[float, float, float, float], periods: int) -> Orbit:
    """Solve for instant and speed of closing, length of contact and speed of leaving."""
    assert o.spring is not None
    with mp.workdps(DIGITS):
        free, held = flight(o), flight(o, o.spring)

        def lacks(start: mpf, speed: mpf, contact: mpf, leaving: mpf) -> list[mpf]:
            x, v = held.after(start, mpf(1), speed, contact)
            rest = periods * o.period - contact
            y, w = free.after(start + contact, mpf(1), -leaving, rest)
            return [x - 1, v + leaving, y - 1, w - speed]

        start, speed, contact, leaving = mp.findroot(lacks, guess, tol=mpf(10) ** -25)
        there = held.transition(contact)
        back = free.transition(periods * o.period - contact)
        return Orbit(o, periods, start % o.period, speed, contact, leaving, back * there)


def rigid_orbit(o: Oscillator, guess: tuple[float, float], periods: int) -> Orbit:
    """Solve for instant and speed of an impact that turns the velocity by the restitution."""
    with mp.workdps(DIGITS):
        free, r = flight(o), mpf(o.restitution)

        def lacks(start: mpf, speed: mpf) -> list[mpf]:
            x, v = free.after(start, mpf(1), -r * speed, periods * o.period)
            return [x - 1, v - speed]

        start, speed = mp.findroot(lacks, guess, tol=mpf(10) ** -25)
        push = free.b * mp.cos(free.w * start) - 1
        before, after = push - 2 * free.a * speed, push + 2 * free.a * r * speed
        # A path that is ahead by dx hits earlier by dx / v, and has turned for that long.
        jump = mp.matrix([[-r, 0], [(after + r * before) / speed, -r]])
        monodromy = free.transition(periods * o.period) * jump
        return Orbit(o, periods, start % o.period, speed, mpf(0), r * speed, monodromy)


def grazing_forcing(o: Oscillator) -> float:
    """Return the forcing at which the motion without impacts just reaches the stop."""
    with mp.workdps(DIGITS):
        a, w = mpf(o.damping), mpf(o.frequency)
        return float(mp.sqrt((1 - w**2) ** 2 + (2 * a * w) ** 2))
