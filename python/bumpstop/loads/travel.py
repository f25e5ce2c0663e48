"""Travel: how far, how fast and how quickly changing supports move, from either end.

An acceleration is integrated twice, from rest, and a displacement differentiated twice; both
exactly: harmonics and polynomials stay what they are, and straight lines of an acceleration make
a displacement of cubics.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.loads.sampling import sampled
from bumpstop.loads.time import HIGHEST_DEGREE, Harmonic, Polynomial, Term, TimeTable

__all__ = ["Cubics", "Travel", "rate"]

_TOLERANCE = 1e-7
"""How far straight lines stray from cubics, relative to the largest value."""


@dataclass(frozen=True, eq=False)
class Cubics:
    """The second integral of a table's straight lines, from zero and at rest.

    Parameters
    ----------
    table
        The second derivative.
    duration
        How far it is needed, in s.
    order
        Which derivative of it this is: 0 or 1.
    """

    table: TimeTable
    duration: float
    order: int = 0

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        return "the integral of a table"

    def at(self, times: FloatArray) -> FloatArray:
        """Return its values at some times in s."""
        knots, first, last, rate, place = self._pieces
        wanted = np.asarray(times, dtype=np.float64)
        piece = np.clip(np.searchsorted(knots[:-1], wanted, side="right") - 1, 0, len(first) - 1)
        since, width = wanted - knots[piece], knots[piece + 1] - knots[piece]
        slope = (last[piece] - first[piece]) / width
        if self.order == 1:
            speeds: FloatArray = rate[piece] + since * (first[piece] + 0.5 * slope * since)
            return speeds
        bent = 0.5 * first[piece] + slope * since / 6.0
        values: FloatArray = place[piece] + since * (rate[piece] + since * bent)
        return values

    def terms(self, duration: float) -> tuple[TimeTable, ...]:
        """Return straight lines through it, within a part of 1e-7 of its largest value."""
        knots = self._pieces[0]
        return (sampled(self.at, knots[knots <= duration], _TOLERANCE),)

    @cached_property
    def _pieces(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
        """Knots, second derivative at both ends of each piece, first one and value at its start."""
        times = np.asarray(self.table.times)
        inside = times[(times > 0.0) & (times < self.duration)]
        knots = np.unique(np.concatenate([[0.0], inside, [self.duration]]))
        first = self.table.at(knots[:-1])
        last = self.table.at(np.nextafter(knots[1:], -np.inf))
        width = np.diff(knots)
        rate = np.concatenate([[0.0], np.cumsum(0.5 * width * (first + last))])
        risen = width * (rate[:-1] + width * (2.0 * first + last) / 6.0)
        return knots, first, last, rate, np.concatenate([[0.0], np.cumsum(risen)])


_Piece = Term | Cubics


@dataclass(frozen=True, eq=False)
class Travel:
    """A motion: displacement, velocity and acceleration as sums of functions of time."""

    displacement: tuple[_Piece, ...]
    velocity: tuple[_Piece, ...]
    acceleration: tuple[Term, ...]

    @classmethod
    def accelerated(cls, terms: Sequence[Term], duration: float) -> Travel:
        """Return the motion from rest with an acceleration.

        Raises
        ------
        InputError
            If it is a polynomial of a degree above three, whose integral is not followed.
        """
        speeds: list[_Piece] = []
        places: list[_Piece] = []
        for term in terms:
            if isinstance(term, TimeTable):
                speeds.append(Cubics(term, duration, 1))
                places.append(Cubics(term, duration))
            elif isinstance(term, Polynomial):
                speeds.append(_integral(term))
                places.append(_integral(_integral(term)))
            else:
                speed, start = _wave_integral(term)
                place, lag = _wave_integral(speed)
                speeds += [speed, Polynomial([start])]
                places += [place, Polynomial([lag, start])]
        return cls(tuple(places), tuple(speeds), tuple(terms))

    @classmethod
    def displaced(cls, terms: Sequence[Term]) -> Travel:
        """Return the motion with a displacement.

        Raises
        ------
        InputError
            If there is a table in it: where straight lines meet, the acceleration is infinite.
        """
        for term in terms:
            if isinstance(term, TimeTable):
                what = "must be of harmonics and polynomials where it is a displacement"
                hint = "give the acceleration of what is told by straight lines"
                raise InputError(what, key="time", value=term.words, hint=hint)
        speeds = tuple(map(rate, terms))
        return cls(tuple(terms), speeds, tuple(map(rate, speeds)))

    @property
    def derivatives(self) -> tuple[tuple[_Piece, ...], ...]:
        """Displacement, velocity and acceleration."""
        return self.displacement, self.velocity, self.acceleration

    def at(self, times: FloatArray, derivative: int = 0) -> FloatArray:
        """Return displacement (0), velocity (1) or acceleration (2) at some times in s."""
        total = np.zeros(np.shape(times))
        for function in self.derivatives[derivative]:
            total = total + function.at(times)
        return total


def _integral(polynomial: Polynomial) -> Polynomial:
    coefficients = [0.0, *(c / (n + 1) for n, c in enumerate(polynomial.coefficients))]
    if len(coefficients) > HIGHEST_DEGREE + 1:
        what = f"must be of degree {HIGHEST_DEGREE - 2} at most where it is an acceleration"
        raise InputError(what, key="polynomial", hint="give the displacement")
    return Polynomial(coefficients)


def _wave_integral(wave: Harmonic) -> tuple[Harmonic, float]:
    """Return the integral of a wave from zero, as a wave and a constant."""
    omega = 2.0 * math.pi * wave.frequency
    integral = Harmonic(wave.frequency, cosine=-wave.sine / omega, sine=wave.cosine / omega)
    return integral, wave.sine / omega


def rate(term: Term) -> Term:
    """Return the derivative of a function; that of straight lines jumps where they meet.

    Examples
    --------
    >>> rate(TimeTable([0.0, 1.0, 3.0], [0.0, 2.0, 0.0])).at([0.5, 1.0, 2.0]).tolist()
    [2.0, -1.0, -1.0]
    """
    if isinstance(term, Harmonic):
        omega = 2.0 * math.pi * term.frequency
        return Harmonic(term.frequency, cosine=omega * term.sine, sine=-omega * term.cosine)
    if isinstance(term, TimeTable):
        return _slopes(term)
    coefficients = [n * c for n, c in enumerate(term.coefficients)][1:]
    return Polynomial(coefficients or [0.0])


def _slopes(table: TimeTable) -> TimeTable:
    times, values = np.asarray(table.times), np.asarray(table.values)
    slopes = np.diff(values) / np.diff(times)
    return TimeTable(np.repeat(times, 2)[1:-1], np.repeat(slopes, 2), beyond="zero")
