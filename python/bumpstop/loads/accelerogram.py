"""Accelerogram: a random acceleration that meets a response spectrum."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, field
from functools import cached_property

import numpy as np

from bumpstop.arguments import FloatArray, count, positive, series
from bumpstop.errors import InputError
from bumpstop.loads.density import ascending
from bumpstop.loads.oscillator_spectrum import Oscillators
from bumpstop.loads.random_signal import phases
from bumpstop.loads.time import TimeTable

__all__ = ["Accelerogram"]

_STEPS_A_PERIOD = 20
_LOOKS_AN_OCTAVE = 12
"""Oscillators an octave whose responses are compared with the target."""
_ROUNDS = 40
_MOST_SAMPLES = 500_000
_CLOSE = 0.01
"""Where every oscillator is this close the search ends."""
_TOLD = 0.1


@dataclass(frozen=True, eq=False)
class Accelerogram:
    """A random acceleration whose response spectrum is, nearly, a given one.

    Waves of random phases under an envelope, which rises as a parabola, stays, and decays. The
    amplitudes of the waves are scaled by target over achieved spectrum, again and again, and the
    best of forty rounds is kept; ``deviation`` tells how close that is. After it, mean and slope
    are taken out so that the base comes to rest: its velocity and displacement end at zero.

    Parameters
    ----------
    frequencies
        Of the target, in Hz, (K,), ascending.
    values
        Pseudo-acceleration there, in the unit that the load's acceleration is multiplied by,
        positive; straight lines between them on logarithmic axes.
    damping
        Ratio of critical damping that the target is for, below one.
    duration
        In s.
    rise, decay
        How long the envelope rises and decays, in s; a sixth and a third of the duration where
        left out.
    seed
        A whole number from zero on.

    Raises
    ------
    InputError
        If a number is out of its range, or the duration is too short for the lowest frequency.

    References
    ----------
    D. A. Gasparini, E. H. Vanmarcke, Simulated earthquake motions compatible with prescribed
    response spectra, MIT R76-4, 1976.

    Examples
    --------
    >>> target = [1.0, 2.5, 9.0, 33.0], [2.0, 4.0, 4.0, 1.5]
    >>> quake = Accelerogram(*target, damping=0.05, duration=15.0, seed=2)
    >>> bool(quake.deviation < 0.1)
    True
    """

    frequencies: Sequence[float] | FloatArray = field(repr=False)
    values: Sequence[float] | FloatArray = field(repr=False)
    _: KW_ONLY
    damping: float
    duration: float
    seed: int
    rise: float | None = None
    decay: float | None = None

    def __post_init__(self) -> None:
        frequencies = ascending("frequencies", self.frequencies)
        positive("frequencies", float(frequencies[0]))
        values = np.array([positive("values", value) for value in series("values", self.values)])
        if len(values) != len(frequencies) or len(values) < 2:
            what = "must have one value for each of two frequencies or more"
            numbers = f"{len(values)} values, {len(frequencies)} frequencies"
            raise InputError(what, key="values", value=numbers)
        for key, numbers_ in (("frequencies", frequencies), ("values", values)):
            numbers_.flags.writeable = False
            object.__setattr__(self, key, numbers_)
        object.__setattr__(self, "damping", positive("damping", self.damping))
        if self.damping >= 1.0:
            raise InputError("must be below 1", key="damping", value=self.damping)
        object.__setattr__(self, "duration", positive("duration", self.duration))
        object.__setattr__(self, "seed", count("seed", self.seed, 0))
        self._check_times(float(frequencies[0]))

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        off = f"{100 * self.deviation:.2g} %"
        return f"an accelerogram within {off} of its spectrum, seed {self.seed}"

    @property
    def remarks(self) -> tuple[str, ...]:
        """Return a line that says so where the target is not met within a tenth."""
        if self.deviation <= _TOLD:
            return ()
        return (
            f"the accelerogram deviates from its response spectrum by up to "
            f"{100 * self.deviation:.3g} %; take another seed or a longer duration",
        )

    def at(self, times: FloatArray) -> FloatArray:
        """Return its values at some times in s; zero before and after."""
        values: FloatArray = self._table.at(times)
        return values

    def terms(self, _: float) -> tuple[TimeTable, ...]:
        """Return the table that it is."""
        return (self._table,)

    def target(self, frequencies: FloatArray) -> FloatArray:
        """Return the target spectrum at some frequencies in Hz."""
        known = np.log(np.asarray(self.frequencies))
        logs: FloatArray = np.interp(np.log(frequencies), known, np.log(np.asarray(self.values)))
        return np.exp(logs)

    @cached_property
    def spectrum(self) -> tuple[FloatArray, FloatArray]:
        """Frequencies in Hz at which it was compared, and its own spectrum there, (F,) each."""
        frequencies = self._looks
        values = np.asarray(self._table.values)
        return frequencies, self._oscillators.pseudo_acceleration(values)

    @cached_property
    def deviation(self) -> float:
        """Largest deviation of its spectrum from the target, relative to this."""
        frequencies, own = self.spectrum
        return float(np.abs(own / self.target(frequencies) - 1.0).max())

    def _check_times(self, lowest: float) -> None:
        for key, share in (("rise", 6.0), ("decay", 3.0)):
            given = getattr(self, key)
            length = self.duration / share if given is None else positive(key, given)
            object.__setattr__(self, key, length)
        if self._rise + self._decay > self.duration:
            what = "and decay must fit into the duration"
            raise InputError(what, key="rise", value=self._rise + self._decay)
        if self.duration * lowest < 2.0:
            what = "is less than two periods of the lowest frequency"
            hint = f"take at least {2.0 / lowest:.3g} s"
            raise InputError(what, key="duration", value=self.duration, hint=hint)
        if self._steps > _MOST_SAMPLES:
            what = f"makes {self._steps:,} samples, more than {_MOST_SAMPLES:,}"
            raise InputError(what, key="duration", value=self.duration)

    @property
    def _rise(self) -> float:
        return self.rise or 0.0

    @property
    def _decay(self) -> float:
        return self.decay or 0.0

    @property
    def _steps(self) -> int:
        highest = float(self.frequencies[-1])
        return 2 * math.ceil(0.5 * _STEPS_A_PERIOD * highest * self.duration)

    @property
    def _step(self) -> float:
        return self.duration / self._steps

    @property
    def _looks(self) -> FloatArray:
        """Frequencies in Hz at which target and own spectrum are compared."""
        known = np.asarray(self.frequencies)
        octaves = math.log2(known[-1] / known[0])
        even = np.geomspace(known[0], known[-1], 2 + math.ceil(_LOOKS_AN_OCTAVE * octaves))
        return np.unique(np.concatenate([even, known]))

    @cached_property
    def _oscillators(self) -> Oscillators:
        return Oscillators(self._looks, self.damping, self._step)

    @cached_property
    def _table(self) -> TimeTable:
        times = self._step * np.arange(self._steps + 1, dtype=np.float64)
        envelope = np.minimum(
            np.minimum(times / self._rise, 1.0) ** 2,
            np.exp(-3.0 * np.maximum(times - (self.duration - self._decay), 0.0) / self._decay),
        )
        ends = _ends(times)
        looks = self._looks
        waves = np.arange(self._steps // 2 + 1, dtype=np.float64) / self.duration
        target = self.target(looks)
        lines = self._first_lines(waves)
        best, least = np.zeros(len(times)), np.inf
        for _ in range(_ROUNDS):
            values = np.fft.irfft(lines, self._steps)
            values = envelope * np.append(values, values[0])
            values = values - envelope * _drift(envelope, values, ends)
            achieved = self._oscillators.pseudo_acceleration(values)
            off = float(np.abs(achieved / target - 1.0).max())
            if off < least:
                best, least = values, off
            if off < _CLOSE:
                break
            inside = np.clip(waves, looks[0], looks[-1])
            lines = lines * np.interp(inside, looks, target / achieved)
        return TimeTable(times, best, beyond="zero")

    def _first_lines(self, waves: FloatArray) -> np.ndarray:
        """Return waves whose power is about what the target asks for, a stationary estimate."""
        known = np.asarray(self.frequencies)
        inside = (waves >= 0.5 * known[0]) & (waves <= known[-1])
        target = self.target(np.clip(waves, known[0], known[-1]))
        # The density of a narrow oscillator's response under white noise, with a peak factor of 3.
        density = np.where(inside, target**2 * self.damping / np.maximum(waves, 0.1), 0.0)
        angles = phases(self.seed, 0, len(waves))
        size = np.sqrt(2.0 * density / self.duration) * self._steps / 6.0
        lines: np.ndarray = size * np.exp(1j * angles)
        return lines


def _ends(times: FloatArray) -> FloatArray:
    """Return the weights of samples in the last velocity and displacement of the base, (2, K).

    For straight lines between the samples, both are sums of them, exactly.
    """
    step, last = float(times[1]), float(times[-1])
    weights: FloatArray = np.stack([np.full(len(times), step), step * (last - times)])
    weights[0, [0, -1]] *= 0.5
    weights[1, 0] = step * (0.5 * last - step / 6.0)
    weights[1, -1] = step**2 / 6.0
    return weights


def _drift(envelope: FloatArray, values: FloatArray, weights: FloatArray) -> FloatArray:
    """Return the straight line that, under the envelope, ends where the values end."""
    place = np.linspace(-1.0, 1.0, len(values))
    lines = np.stack([np.ones(len(values)), place])
    parts = np.linalg.solve(weights @ (envelope * lines).T, weights @ values)
    line: FloatArray = (parts @ lines).astype(np.float64)
    return line
