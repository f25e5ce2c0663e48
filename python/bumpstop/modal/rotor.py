"""The Campbell diagram: frequencies of a rotor against the speed at which it spins."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from bumpstop.arguments import FloatArray, finite, series
from bumpstop.errors import InputError
from bumpstop.modal.basis import ModalBasis
from bumpstop.modal.oscillation import ComplexModes, complex_modes

__all__ = ["Campbell", "campbell"]


@dataclass(frozen=True, eq=False)
class Campbell:
    """Frequencies, damping and whirl of a rotor at several speeds.

    Parameters
    ----------
    speeds
        In rad/s, (S,).
    frequencies
        Of the oscillations at each speed in Hz, ascending, (S, n); NaN where there are fewer.
    damping_ratio
        Ratios of critical damping, (S, n); negative where the rotor is unstable.
    whirl
        From -1 (backward) to 1 (forward), (S, n); see `ComplexModes.whirl`.
    """

    speeds: FloatArray
    frequencies: FloatArray = field(repr=False)
    damping_ratio: FloatArray = field(repr=False)
    whirl: FloatArray = field(repr=False)


def campbell(
    rotor: ModalBasis | Callable[[float], ModalBasis],
    speeds: Sequence[float],
    *,
    spin: float = 1.0,
    axis: Sequence[float] = (1.0, 0.0, 0.0),
    count: int | None = None,
) -> Campbell:
    """Return the frequencies of a rotor at several speeds.

    Parameters
    ----------
    rotor
        A basis of the rotor at the speed ``spin``, whose gyroscopic matrix grows in proportion
        to the speed; or a function that makes a basis for a speed in rad/s, where more of it
        changes.
    speeds
        Speeds in rad/s.
    spin
        Speed in rad/s that the gyroscopic matrix of the basis belongs to.
    axis
        Direction (x, y, z) of the spin.
    count
        How many of the lowest oscillations to give; all where left out.

    Raises
    ------
    InputError
        If a speed is not finite, ``spin`` is zero, or the axis has no length.
    """
    at = _scaled(rotor, spin) if isinstance(rotor, ModalBasis) else rotor
    asked = np.array(series("speeds", speeds))
    modes = [complex_modes(at(speed)) for speed in asked.tolist()]
    oscillating = [np.flatnonzero(found.frequencies > 0.0)[:count] for found in modes]
    most = max(len(rows) for rows in oscillating)

    def table(quantity: Callable[[ComplexModes], FloatArray]) -> FloatArray:
        values = np.full((len(asked), most), np.nan)
        for row, (found, kept) in enumerate(zip(modes, oscillating, strict=True)):
            values[row, : len(kept)] = quantity(found)[kept]
        return values

    return Campbell(
        asked,
        table(lambda found: found.frequencies),
        table(lambda found: found.damping_ratio),
        table(lambda found: found.whirl(axis)),
    )


def _scaled(basis: ModalBasis, spin: float) -> Callable[[float], ModalBasis]:
    """Return how to make the basis for another speed."""
    if finite("spin", spin) == 0.0:
        hint = "make the basis of a rotor that spins"
        raise InputError("must not be zero", key="spin", value=spin, hint=hint)
    gyroscopic = basis.gyroscopic
    if gyroscopic is None:
        return lambda _speed: basis
    return lambda speed: replace(basis, gyroscopic=gyroscopic * (speed / spin))
