"""Damping of the modes of a basis: what the user says, and what dampers in the model add."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray, not_negative, one_of
from bumpstop.errors import InputError
from bumpstop.modal.damping import Damping, DampingLaw, angular_frequencies
from bumpstop.modal.given import one_or_each

__all__ = ["ModalDamping", "modal_damping", "with_companions"]

COUPLINGS = ("full", "diagonal")


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
        ratio = one_or_each("damping", damping, len(omega2), not_negative)
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
    return [*one_or_each("damping", damping, modes, not_negative).tolist(), *[ratio] * companions]


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
