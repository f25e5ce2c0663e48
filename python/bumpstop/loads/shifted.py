"""Shifted: a function of time from an instant on."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.loads.time import Harmonic, Polynomial, Term, TimeFunction, TimeTable

__all__ = ["Shifted"]


@dataclass(frozen=True, eq=False)
class Shifted:
    """``function(t + instant)``.

    Parameters
    ----------
    function
        A function of time.
    instant
        In s, zero or later.
    drawn
        For how long the function is known already by straight lines where it needs such, in s
        from its own start: a run no longer than that follows the same ones.

    Examples
    --------
    >>> Shifted(Polynomial([1.0, 2.0]), 0.5).terms(1.0)
    (Polynomial(coefficients=(2.0, 2.0)),)
    """

    function: TimeFunction
    instant: float
    drawn: float = 0.0

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        return f"{self.function.words} from {self.instant:g} s on"

    def at(self, times: FloatArray) -> FloatArray:
        """Return its values at some times in s."""
        return self.function.at(np.asarray(times, dtype=np.float64) + self.instant)

    def terms(self, duration: float) -> tuple[Term, ...]:
        """Return the terms whose sum it is over a run."""
        whole = max(self.instant + duration, self.drawn)
        return tuple(_later(term, self.instant) for term in self.function.terms(whole))


def _later(term: Term, instant: float) -> Term:
    if isinstance(term, Harmonic):
        angle = 2.0 * math.pi * term.frequency * instant
        cosine, sine = math.cos(angle), math.sin(angle)
        return Harmonic(
            term.frequency,
            cosine=term.cosine * cosine + term.sine * sine,
            sine=term.sine * cosine - term.cosine * sine,
        )
    if isinstance(term, Polynomial):
        moved = np.polynomial.Polynomial(term.coefficients)(
            np.polynomial.Polynomial([instant, 1.0])
        )
        return Polynomial([float(c) for c in moved.coef])
    times, values = np.asarray(term.times), np.asarray(term.values)
    return TimeTable(times - instant, values, beyond=term.beyond)
