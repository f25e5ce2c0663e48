"""Power spectral densities, one-sided, as tables over frequency."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, field

import numpy as np

from bumpstop.arguments import FloatArray, one_of, series
from bumpstop.errors import InputError

__all__ = ["SpectralDensity", "ascending"]

INTERPOLATIONS = ("logarithmic", "linear")
_LEVEL = 1e-9
"""A power of frequency this close to -1 is integrated as a logarithm."""


@dataclass(frozen=True, eq=False)
class SpectralDensity:
    """A one-sided power spectral density: the variance is its integral over frequency from 0 on.

    Parameters
    ----------
    frequencies
        In Hz, (K,), ascending.
    values
        The density there, in the square of a unit per Hz: N^2/Hz, (m/s2)^2/Hz; not negative. It
        is zero below the first frequency and above the last.
    interpolation
        ``"logarithmic"``: straight lines between the values where both axes are logarithmic,
        as standards draw them; ``"linear"``: where both are linear.

    Raises
    ------
    InputError
        If the lists differ in length, frequencies do not ascend, a value is negative, or all are
        zero; or a logarithmic one has a zero in it.

    Examples
    --------
    >>> band = SpectralDensity([10.0, 20.0], [0.3, 0.3])
    >>> round(band.rms, 12)
    1.732050807569
    """

    frequencies: Sequence[float] | FloatArray = field(repr=False)
    values: Sequence[float] | FloatArray = field(repr=False)
    _: KW_ONLY
    interpolation: str = "logarithmic"

    def __post_init__(self) -> None:
        frequencies = ascending("frequencies", self.frequencies)
        values = np.array(series("values", self.values))
        if len(frequencies) != len(values) or len(values) < 2:
            what = "must have one value for each of two frequencies or more"
            numbers = f"{len(values)} values, {len(frequencies)} frequencies"
            raise InputError(what, key="values", value=numbers)
        one_of("interpolation", self.interpolation, INTERPOLATIONS)
        if np.any(values < 0.0):
            raise InputError("must not be negative", key="values", value=float(values.min()))
        if not values.any():
            raise InputError("must not all be zero", key="values", value="zeros")
        if self.interpolation == "logarithmic" and (frequencies[0] == 0.0 or np.any(values == 0.0)):
            what = "must be above zero, frequencies too, for logarithmic axes"
            raise InputError(what, key="values", value=0.0, hint='interpolation = "linear"')
        for key, numbers_ in (("frequencies", frequencies), ("values", values)):
            numbers_.flags.writeable = False
            object.__setattr__(self, key, numbers_)

    @property
    def highest(self) -> float:
        """The highest frequency in Hz."""
        return float(self.frequencies[-1])

    @property
    def rms(self) -> float:
        """The root of the integral over all frequencies."""
        return float(np.sqrt(self.variance_below(np.array([self.highest]))[0]))

    def at(self, frequencies: FloatArray) -> FloatArray:
        """Return the density at some frequencies in Hz."""
        known, values = np.asarray(self.frequencies), np.asarray(self.values)
        wanted = np.asarray(frequencies, dtype=np.float64)
        inside = (wanted >= known[0]) & (wanted <= known[-1])
        if self.interpolation == "linear":
            return np.where(inside, np.interp(wanted, known, values), 0.0)
        logs = np.log(np.where(inside, wanted, known[0]))
        return np.where(inside, np.exp(np.interp(logs, np.log(known), np.log(values))), 0.0)

    def variance_below(self, frequencies: FloatArray) -> FloatArray:
        """Return the integral of the density from zero to some frequencies in Hz, exactly."""
        known = np.asarray(self.frequencies)
        wanted = np.clip(np.asarray(frequencies, dtype=np.float64), known[0], known[-1])
        place = np.clip(np.searchsorted(known, wanted, side="right") - 1, 0, len(known) - 2)
        whole = self._between(np.arange(len(known) - 1), known[1:])
        before = np.concatenate([[0.0], np.cumsum(whole)])
        return before[place] + self._between(place, wanted)

    def _between(self, place: np.ndarray, to: FloatArray) -> FloatArray:
        """Return the integrals from the frequencies of some numbers to others."""
        known, values = np.asarray(self.frequencies), np.asarray(self.values)
        left, right = known[place], known[place + 1]
        first, last = values[place], values[place + 1]
        if self.interpolation == "linear":
            slope = (last - first) / (right - left)
            linear: FloatArray = (to - left) * (first + 0.5 * slope * (to - left))
            return linear
        power = np.log(last / first) / np.log(right / left) + 1.0
        ratio = np.log(to / left)
        level = np.abs(power) < _LEVEL
        grown = np.where(level, ratio, np.expm1(power * ratio) / np.where(level, 1.0, power))
        logarithmic: FloatArray = first * left * grown
        return logarithmic


def ascending(key: str, value: object) -> FloatArray:
    """Return frequencies in Hz as an array, which must ascend from zero or above."""
    frequencies = np.array(series(key, value))
    if frequencies[0] < 0.0:
        raise InputError("must not be negative", key=key, value=float(frequencies[0]))
    back = np.flatnonzero(np.diff(frequencies) <= 0.0)
    if len(back):
        at = int(back[0]) + 1
        hint = f"entry {at + 1} is not above the one before it"
        raise InputError("must ascend", key=key, value=float(frequencies[at]), hint=hint)
    return frequencies
