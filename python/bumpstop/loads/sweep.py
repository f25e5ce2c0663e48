"""Sweep: a sine whose frequency rises or falls."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from functools import lru_cache

import numpy as np

from bumpstop.arguments import FloatArray, finite, not_negative, one_of, pair, positive
from bumpstop.errors import InputError
from bumpstop.loads.sampling import MOST_KNOTS, TOLERANCE, checked_tolerance, too_many
from bumpstop.loads.time import TimeTable

__all__ = ["Sweep"]

SPACINGS = ("linear", "logarithmic")
_PIECES = 64
"""Pieces of a sweep in each of which the highest frequency decides on the lines."""


@dataclass(frozen=True)
class Sweep:
    """A chirp, ``amplitude sin(phase + 2 pi times the integral of f(t))``; zero before and after.

    The frequency goes in proportion to time, or by as many octaves in every second. The exact
    method follows straight lines through the sweep. Lines of length h deviate from it by at most
    ``h^2 / 8 max |y''|`` with ``|y''| <= amplitude ((2 pi f)^2 + |2 pi f'|)``; their lengths
    are chosen by that bound.

    Parameters
    ----------
    frequencies
        At its begin and at its end, in Hz; the second may be the lower one.
    duration
        How long it takes, in s.
    spacing
        ``"linear"`` or ``"logarithmic"``.
    amplitude
        Its amplitude.
    phase
        Where in its period it begins, in rad.
    start
        When it begins, in s from the start of the run.
    tolerance
        Largest deviation of the straight lines, relative to the amplitude.

    Raises
    ------
    InputError
        If a number is out of its range, or the sweep takes more than two million lines.

    Examples
    --------
    >>> chirp = Sweep((5.0, 50.0), duration=10.0)
    >>> float(chirp.frequency(5.0))
    27.5
    >>> (table,) = chirp.terms(10.0)
    >>> times = np.linspace(0.0, 9.9, 1234)
    >>> bool(np.abs(table.at(times) - chirp.at(times)).max() <= 1e-4)
    True
    """

    frequencies: Sequence[float]
    _: KW_ONLY
    duration: float
    spacing: str = "linear"
    amplitude: float = 1.0
    phase: float = 0.0
    start: float = 0.0
    tolerance: float = TOLERANCE

    def __post_init__(self) -> None:
        first, last = pair("frequencies", self.frequencies)
        one_of("spacing", self.spacing, SPACINGS)
        check = positive if self.spacing == "logarithmic" else not_negative
        ends = (check("frequencies", first), check("frequencies", last))
        object.__setattr__(self, "frequencies", ends)
        if max(first, last) == 0.0:
            raise InputError("must not both be zero", key="frequencies", value=self.frequencies)
        object.__setattr__(self, "duration", positive("duration", self.duration))
        for key in ("amplitude", "phase"):
            object.__setattr__(self, key, finite(key, getattr(self, key)))
        object.__setattr__(self, "start", not_negative("start", self.start))
        object.__setattr__(self, "tolerance", checked_tolerance(self.tolerance))

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        first, last = self.frequencies
        return f"a {self.spacing} sweep from {first:g} to {last:g} Hz"

    def frequency(self, times: float | FloatArray) -> FloatArray:
        """Return the frequency in Hz at some times in s after its begin."""
        first, last = self.frequencies
        part = np.asarray(times, dtype=np.float64) / self.duration
        if self.spacing == "linear":
            return first + (last - first) * part
        return np.asarray(first * (last / first) ** part)

    def at(self, times: FloatArray) -> FloatArray:
        """Return its values at some times in s from the start of the run."""
        since = np.asarray(times, dtype=np.float64) - self.start
        during = (since >= 0.0) & (since < self.duration)
        turns = self._turns(np.where(during, since, 0.0))
        values: FloatArray = self.amplitude * np.sin(self.phase + 2.0 * math.pi * turns)
        return np.where(during, values, 0.0)

    @lru_cache(maxsize=16)  # noqa: B019  # asked for when a problem is made, and when it is run
    def terms(self, duration: float) -> tuple[TimeTable, ...]:
        """Return its straight lines as far as a run of some duration in s needs them.

        Raises
        ------
        InputError
            If there are more than two million of them.
        """
        until = min(self.duration, duration - self.start)
        if until <= 0.0 or self.amplitude == 0.0:
            return (TimeTable([0.0, duration], [0.0, 0.0], beyond="zero"),)
        since = self._knots(until)
        values = self.amplitude * np.sin(self.phase + 2.0 * math.pi * self._turns(since))
        return (TimeTable(self.start + since, values, beyond="zero"),)

    def _turns(self, since: FloatArray) -> FloatArray:
        """Return the integral of the frequency from the begin of the sweep."""
        first, last = self.frequencies
        if self.spacing == "linear":
            return first * since + (last - first) * since**2 / (2.0 * self.duration)
        octaves = math.log(last / first)
        if octaves == 0.0:
            return first * since
        growth: FloatArray = np.expm1(octaves * since / self.duration)
        return first * self.duration / octaves * growth

    def _knots(self, until: float) -> FloatArray:
        """Return times since the begin, (K,), between which straight lines will do."""
        edges = np.linspace(0.0, until, _PIECES + 1)
        speed = 2.0 * math.pi * self.frequency(edges)
        change = np.abs(2.0 * math.pi * self._rate(edges))
        bend = np.maximum(speed[:-1], speed[1:]) ** 2 + np.maximum(change[:-1], change[1:])
        length = until / _PIECES
        # Of one more line each: so that what rounding adds stays within the tolerance too.
        lines = np.ceil(length * np.sqrt(bend / (8.0 * self.tolerance))) + 1.0
        if lines.sum() > MOST_KNOTS:
            raise too_many(self.tolerance)
        pieces = [
            np.linspace(begin, end, int(count), endpoint=False)
            for begin, end, count in zip(edges[:-1], edges[1:], lines, strict=True)
        ]
        return np.concatenate([*pieces, edges[-1:]])

    def _rate(self, since: FloatArray) -> FloatArray:
        """Return the rate of the frequency in Hz/s."""
        first, last = self.frequencies
        if self.spacing == "linear":
            return np.full_like(since, (last - first) / self.duration)
        return self.frequency(since) * (math.log(last / first) / self.duration)
