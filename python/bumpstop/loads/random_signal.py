"""RandomSignal: a stationary random function of time with a given spectral density."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass
from functools import cached_property

import numpy as np

from bumpstop.arguments import FloatArray, count, positive
from bumpstop.errors import InputError
from bumpstop.loads.density import SpectralDensity
from bumpstop.loads.sampling import MOST_KNOTS
from bumpstop.loads.time import TimeTable

__all__ = ["RandomSignal", "from_lines", "phases"]

STEPS_A_PERIOD = 20
"""Straight lines in a period of the highest frequency."""
_FEWEST_LINES = 10


@dataclass(frozen=True, eq=False)
class RandomSignal:
    """Waves of all frequencies with random phases, whose powers are those of a density.

    ``sum of a_k cos(2 pi k t / period + phase_k)``, where ``a_k^2 / 2`` is the integral of the
    density over the band of each wave: the spectral representation of Shinozuka and Deodatis.
    The variance over a period is that of the density whatever the seed; with many waves values are
    normally distributed. The same seed gives the same signal, to the bit with the same numpy.

    The exact method follows straight lines between samples at a twentieth of the period of the
    highest frequency. Lines weaken a wave of frequency f by ``(sin(x)/x)^2`` with ``x = pi f
    step``; the samples are raised by as much, so that all waves have their power in the lines too.

    Parameters
    ----------
    density
        The one-sided spectral density.
    seed
        A whole number from zero on, which decides all phases.
    period
        After how long in s the signal repeats itself: at least as long as is simulated.
    stream
        Another whole number, for independent signals of one seed.

    Raises
    ------
    InputError
        If a number is out of its range, there are fewer than ten waves in the band of the
        density, or more samples than two million.

    References
    ----------
    M. Shinozuka, G. Deodatis, Simulation of stochastic processes by spectral representation,
    Applied Mechanics Reviews 44 (1991).

    Examples
    --------
    >>> noise = RandomSignal(SpectralDensity([10.0, 20.0], [0.3, 0.3]), seed=1, period=20.0)
    >>> values = noise.at(np.arange(100_000) * 2e-4)
    >>> round(float(np.sqrt(np.mean(values**2))), 4), round(noise.density.rms, 4)
    (1.7321, 1.7321)
    """

    density: SpectralDensity
    _: KW_ONLY
    seed: int
    period: float
    stream: int = 0

    def __post_init__(self) -> None:
        if not isinstance(self.density, SpectralDensity):
            raise InputError("must be a SpectralDensity", key="density", value=self.density)
        object.__setattr__(self, "seed", count("seed", self.seed, 0))
        object.__setattr__(self, "stream", count("stream", self.stream, 0))
        object.__setattr__(self, "period", positive("period", self.period))
        band = self.density.highest - float(self.density.frequencies[0])
        if band * self.period < _FEWEST_LINES:
            hint = f"take at least {_FEWEST_LINES / band:.3g} s, or a wider density"
            what = f"leaves fewer than {_FEWEST_LINES} waves in the band of the density"
            raise InputError(what, key="period", value=self.period, hint=hint)
        if self._steps > MOST_KNOTS:
            what = f"makes {self._steps:,} samples, more than {MOST_KNOTS:,}"
            hint = "take a shorter one, or cut the density at a lower frequency"
            raise InputError(what, key="period", value=self.period, hint=hint)

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        return f"a random signal of rms {self.density.rms:.4g}, seed {self.seed}"

    def at(self, times: FloatArray) -> FloatArray:
        """Return the values of its straight lines at some times in s."""
        times_, values = self.samples
        wanted = np.mod(np.asarray(times, dtype=np.float64), self.period)
        return np.interp(wanted, times_, values)

    def terms(self, duration: float) -> tuple[TimeTable, ...]:
        """Return its straight lines over a run, which repeat if that is longer than the period."""
        times, values = self.samples
        rounds = math.ceil(duration / self.period)
        if rounds > 1:
            starts = self.period * np.arange(rounds)
            times = np.append((starts[:, np.newaxis] + times[:-1]).ravel(), rounds * self.period)
            values = np.append(np.tile(values[:-1], rounds), values[-1])
        return (TimeTable(times, values),)

    @cached_property
    def samples(self) -> tuple[FloatArray, FloatArray]:
        """Times in s of one period, and the values there, (K,) each; the last is the first."""
        steps = self._steps
        edges = (np.arange(steps // 2 + 2, dtype=np.float64) - 0.5) / self.period
        below = self.density.variance_below(edges)
        amplitudes = np.sqrt(2.0 * np.diff(below))
        angles = phases(self.seed, self.stream, len(amplitudes))
        return from_lines(amplitudes, angles, steps, self.period)

    @property
    def _steps(self) -> int:
        """Number of samples of a period, even."""
        return 2 * math.ceil(0.5 * STEPS_A_PERIOD * self.density.highest * self.period)


def phases(seed: int, stream: int, number: int) -> FloatArray:
    """Return random angles in rad, the same with any version of numpy."""
    # The bits of PCG64 never change, while what a Generator makes of them may.
    bits = np.random.PCG64(np.random.SeedSequence((seed, stream))).random_raw(number)
    uniform: FloatArray = (bits >> np.uint64(11)).astype(np.float64) * 2.0**-53
    return 2.0 * np.pi * uniform


def from_lines(
    amplitudes: FloatArray, angles: FloatArray, steps: int, period: float
) -> tuple[FloatArray, FloatArray]:
    """Return samples whose straight lines have waves of given amplitudes.

    Parameters
    ----------
    amplitudes, angles
        Of the waves of 0, 1, 2, ... periods a period, (steps / 2 + 1,).
    steps
        Number of samples of a period, even.
    period
        In s.

    Returns
    -------
    tuple
        Times and values, (steps + 1,) each.
    """
    number = np.arange(len(amplitudes))
    raised = amplitudes / np.sinc(number / steps) ** 2
    lines = 0.5 * steps * raised * np.exp(1j * angles)
    values = np.fft.irfft(lines, steps)
    times = period / steps * np.arange(steps + 1, dtype=np.float64)
    times[-1] = period
    return times, np.append(values, values[0])
