"""Damping of the modes: ratios, Rayleigh's, structural, and what dampers in the model add."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import NamedTuple, Protocol, TypeAlias, runtime_checkable

import numpy as np

from bumpstop.arguments import FloatArray, not_negative, one_of, pair, positive, series
from bumpstop.errors import InputError

__all__ = [
    "Damping",
    "DampingLaw",
    "ModalDamping",
    "RayleighDamping",
    "StructuralDamping",
    "angular_frequencies",
    "modal_damping",
    "with_companions",
]

COUPLINGS = ("full", "diagonal")


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


class ModalDamping(NamedTuple):
    """Damping of N modes."""

    ratio: FloatArray
    """Ratios of critical damping (N,), of the diagonal; where a matrix damps a rigid mode, 0."""
    matrix: FloatArray | None
    """Symmetric modal damping matrix (N, N) in rad/s; None where the ratios say it all."""
    neglected: str | None
    """What was left out beside the diagonal, in words."""


def modal_damping(
    damping: object,
    omega2: FloatArray,
    dampers: FloatArray | None = None,
    coupling: str = "full",
) -> ModalDamping:
    """Return the damping of modes: what the user says, and the model's dampers added to it.

    Parameters
    ----------
    damping
        A ratio for all modes, a list of ratios, or a rule such as ``RayleighDamping``.
    omega2
        Squared angular frequencies in rad2/s2, (N,).
    dampers
        The model's damping matrix on the modes, (N, N); None where it has no dampers.
    coupling
        ``"full"``, or ``"diagonal"`` to neglect what couples the modes.

    Raises
    ------
    InputError
        If a ratio is negative or not finite, their number is not that of the modes, or the
        coupling is unknown.

    Examples
    --------
    >>> modal_damping([0.01, 0.02], np.array([4.0, 9.0])).ratio
    array([0.01, 0.02])
    >>> modal_damping(0.0, np.array([4.0, 9.0]), np.diag([0.4, 0.0])).ratio
    array([0.1, 0. ])
    """
    one_of("damping_coupling", coupling, COUPLINGS)
    if isinstance(damping, DampingLaw):
        own = damping.modal(omega2)
        if dampers is None and not own[omega2 <= 0.0].any():
            return ModalDamping(_ratio_of(own, omega2), None, None)
    else:
        ratio = _ratios(damping, len(omega2))
        if dampers is None:
            return ModalDamping(ratio, None, None)
        own = 2.0 * ratio * angular_frequencies(omega2)
    matrix = np.diag(own) if dampers is None else np.diag(own) + dampers
    neglected = None
    if coupling == "diagonal":
        neglected = _coupling(matrix)
        matrix = np.diag(matrix.diagonal())
    return ModalDamping(_ratio_of(matrix.diagonal(), omega2), matrix, neglected)


def with_companions(damping: Damping, own: float | None, modes: int, companions: int) -> Damping:
    """Return the damping of modes and of static shapes beside them.

    Parameters
    ----------
    damping
        That of the modes.
    own
        Ratio of critical damping of the static shapes; as the modes where it is None.
    modes, companions
        How many there are.

    Raises
    ------
    InputError
        If the modes have a list of ratios and the static shapes none, or a rule gives both.

    Examples
    --------
    >>> with_companions([0.01, 0.02], 0.05, 2, 1)
    [0.01, 0.02, 0.05]
    """
    if own is None and (companions == 0 or isinstance(damping, DampingLaw)):
        return damping
    if isinstance(damping, DampingLaw):
        hint = "leave it out: the rule holds for the static shapes too"
        raise InputError("does not go with this damping", key="static_damping", hint=hint)
    listed = np.ndim(damping) > 0
    if own is None and listed:
        hint = "with a list of ratios for the modes, give the static shapes their own"
        raise InputError("is missing", key="static_damping", hint=hint)
    ratio = not_negative("static_damping", damping if own is None else own)
    return [*_ratios(damping, modes).tolist(), *[ratio] * companions]


def angular_frequencies(omega2: FloatArray) -> FloatArray:
    """Return angular frequencies in rad/s; 0 where a mode is rigid or does not vibrate."""
    frequencies: FloatArray = np.sqrt(np.maximum(omega2, 0.0))
    return frequencies


def _ratios(damping: object, modes: int) -> FloatArray:
    """Return one ratio of critical damping a mode, from one for all or one for each."""
    if np.ndim(damping) == 0:  # type: ignore[arg-type]  # object: the check is what is done here
        return np.full(modes, not_negative("damping", damping))
    ratios = series("damping", damping)
    if len(ratios) != modes:
        what = f"must be one number, or one for each of the {modes} modes"
        raise InputError(what, key="damping", value=damping)
    return np.array([not_negative("damping", ratio) for ratio in ratios])


def _ratio_of(damping: FloatArray, omega2: FloatArray) -> FloatArray:
    critical = 2.0 * angular_frequencies(omega2)
    return np.divide(damping, critical, out=np.zeros(len(damping)), where=critical > 0.0)


def _coupling(matrix: FloatArray) -> str | None:
    """Say which term beside the diagonal is the largest, relative to those on it."""
    own = np.sqrt(np.abs(matrix.diagonal()))
    beside = np.abs(matrix - np.diag(matrix.diagonal()))
    if not beside.any():
        return None
    scale = np.outer(own, own)
    share = np.divide(beside, scale, out=np.full(beside.shape, np.inf), where=scale > 0.0)
    share[beside == 0.0] = 0.0
    first, second = np.unravel_index(share.argmax(), share.shape)
    return (
        f"damping that couples modes is neglected, at most {100.0 * share.max():.3g} % of the "
        f"modes' own (between {first + 1} and {second + 1})"
    )
