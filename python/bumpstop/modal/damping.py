"""Rules that give each mode its damping: Rayleigh's, structural."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import Protocol, TypeAlias, runtime_checkable

import numpy as np

from bumpstop.arguments import FloatArray, not_negative, pair, positive
from bumpstop.errors import InputError

__all__ = [
    "Damping",
    "DampingLaw",
    "RayleighDamping",
    "StructuralDamping",
    "angular_frequencies",
]


@runtime_checkable
class DampingLaw(Protocol):
    """A rule that gives each mode its damping."""

    def modal(self, omega2: FloatArray) -> FloatArray:
        """Return the damping of each modal equation in rad/s, (N,)."""


@dataclass(frozen=True)
class RayleighDamping:
    """A damping matrix C = alpha M + beta K.

    A mode of angular frequency w gets the ratio alpha / 2 w + beta w / 2, a rigid one the
    damping alpha (Rayleigh, The Theory of Sound, 1877, section 97).

    Parameters
    ----------
    alpha
        Damping by mass, in 1/s.
    beta
        Damping by stiffness, in s.

    Raises
    ------
    InputError
        If a number is negative or not finite.

    Examples
    --------
    >>> RayleighDamping(alpha=2.0, beta=1e-4).modal(np.array([0.0, 1e4]))
    array([2., 3.])
    """

    _: KW_ONLY
    alpha: float = 0.0
    beta: float = 0.0

    def __post_init__(self) -> None:
        for key in ("alpha", "beta"):
            object.__setattr__(self, key, not_negative(key, getattr(self, key)))

    @classmethod
    def from_ratios(
        cls, *, frequencies: Sequence[float], ratios: Sequence[float]
    ) -> RayleighDamping:
        """Return the damping with given ratios at two frequencies.

        Parameters
        ----------
        frequencies
            Two different frequencies in Hz.
        ratios
            Ratio of critical damping at each.

        Raises
        ------
        InputError
            If a number cannot be used, or the ratios differ by more than the frequencies:
            one of the two terms would have to be negative.

        Examples
        --------
        >>> damping = RayleighDamping.from_ratios(frequencies=[10, 40], ratios=[0.02, 0.02])
        >>> ratios = damping.modal((2 * np.pi * np.array([10.0, 20.0, 40.0])) ** 2)
        >>> (ratios / (4 * np.pi * np.array([10.0, 20.0, 40.0]))).round(6).tolist()
        [0.02, 0.016, 0.02]
        """
        low, high = (
            2.0 * math.pi * positive("frequencies", value)
            for value in pair("frequencies", frequencies)
        )
        at_low, at_high = (not_negative("ratios", value) for value in pair("ratios", ratios))
        if low == high:
            raise InputError("must differ", key="frequencies", value=frequencies)
        alpha = 2.0 * low * high * (at_low * high - at_high * low) / (high**2 - low**2)
        beta = 2.0 * (at_high * high - at_low * low) / (high**2 - low**2)
        if alpha < 0.0 or beta < 0.0:
            term = "alpha" if alpha < 0.0 else "beta"
            raise InputError(
                f"would make {term} negative",
                key="ratios",
                value=ratios,
                hint="Rayleigh's ratios change at most as fast as the frequency",
            )
        return cls(alpha=alpha, beta=beta)

    def modal(self, omega2: FloatArray) -> FloatArray:
        """Return the damping of each modal equation in rad/s, (N,)."""
        return self.alpha + self.beta * omega2


@dataclass(frozen=True)
class StructuralDamping:
    """Structural (hysteretic) damping, as the viscous damping equal to it at each mode.

    A complex stiffness (1 + i eta) K loses per cycle the share 2 pi eta of the energy at any
    frequency. It has no causal form in the time domain; what is taken is the viscous damper
    that loses as much at the mode's own frequency: the ratio eta / 2
    (S. H. Crandall, The role of damping in vibration theory, J. Sound Vib. 11 (1970), 3-18).

    Parameters
    ----------
    loss_factor
        The loss factor eta, a pure number.

    Raises
    ------
    InputError
        If it is negative or not finite.

    Examples
    --------
    >>> StructuralDamping(0.02).modal(np.array([0.0, 1e4]))
    array([0., 2.])
    """

    loss_factor: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "loss_factor", not_negative("loss_factor", self.loss_factor))

    def modal(self, omega2: FloatArray) -> FloatArray:
        """Return the damping of each modal equation in rad/s, (N,)."""
        return self.loss_factor * angular_frequencies(omega2)


Damping: TypeAlias = float | Sequence[float] | DampingLaw
"""One ratio of critical damping for all modes, one for each, or a rule."""


def angular_frequencies(omega2: FloatArray) -> FloatArray:
    """Return angular frequencies in rad/s; 0 where a mode is rigid or does not vibrate."""
    frequencies: FloatArray = np.sqrt(np.maximum(omega2, 0.0))
    return frequencies
