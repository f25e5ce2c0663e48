"""Where a selection of modes begins and ends among known eigenvalues."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.modal.selection import (
    AllModes,
    LowestModes,
    ModesAround,
    ModeSelection,
    ModesInBand,
)
from bumpstop.structure.sparse import IndexArray

__all__ = ["Range", "chosen", "omega2_of", "range_of", "require_modes"]

ENDS = 1e-9
"""A band is this much wider than said, so that a mode on its end belongs to it."""
GAP = 1e-5
"""The least relative distance of two eigenvalues between which a range can end."""
SMALL = 1e-6
"""A band from zero starts this much of the lowest vibration below it."""


class Range(NamedTuple):
    """An open range of squared angular frequencies."""

    low: float = -math.inf
    high: float = math.inf

    def holds(self, omega2: FloatArray) -> IndexArray:
        """Return the numbers of the values inside."""
        return np.flatnonzero((self.low < omega2) & (omega2 < self.high))

    def common(self, other: Range) -> Range:
        """Return what lies in both."""
        return Range(max(self.low, other.low), min(self.high, other.high))


def omega2_of(frequency: float) -> float:
    """Return a squared angular frequency in rad2/s2 from a frequency in Hz."""
    return (2.0 * math.pi * frequency) ** 2


def range_of(selection: ModeSelection, omega2: FloatArray) -> Range:
    """Return a range that holds the selected of some eigenvalues, its ends away from others.

    Parameters
    ----------
    selection
        What is asked for.
    omega2
        Eigenvalues in rad2/s2, ascending, enough of them to see the next beyond the selected.
    """
    if isinstance(selection, AllModes):
        return Range()
    if isinstance(selection, LowestModes):
        return Range(high=_gap_after(omega2, selection.count))
    if isinstance(selection, ModesAround):
        centre = omega2_of(selection.frequency)
        radius = _gap_after(np.sort(np.abs(omega2 - centre)), selection.count)
        return Range(centre - radius, centre + radius)
    low, high = omega2_of(selection.low), omega2_of(selection.high)
    vibrations = omega2[omega2 > SMALL * high]
    below_zero = -SMALL * float(vibrations.min(initial=high))
    return Range(low * (1.0 - ENDS) if low > 0.0 else below_zero, high * (1.0 + ENDS))


def chosen(selection: ModeSelection, omega2: FloatArray) -> IndexArray:
    """Return the numbers of the selected among the eigenvalues of its range, ascending."""
    if isinstance(selection, LowestModes):
        return np.arange(min(selection.count, len(omega2)))
    if isinstance(selection, ModesAround):
        away = np.abs(omega2 - omega2_of(selection.frequency))
        return np.sort(np.argsort(away, kind="stable")[: selection.count])
    return np.arange(len(omega2))


def require_modes(found: int, selection: ModeSelection) -> None:
    """Raise InputError where nothing was found, as only in a band can be.

    >>> require_modes(0, ModesInBand(10.0, 25.0))
    Traceback (most recent call last):
    bumpstop.errors.InputError: modes: there is no mode from 10 Hz to 25 Hz
    """
    if found == 0 and isinstance(selection, ModesInBand):
        band = f"from {selection.low:g} Hz to {selection.high:g} Hz"
        raise InputError(f"there is no mode {band}", key="modes")


def _gap_after(values: FloatArray, count: int) -> float:
    """Return the middle of the first gap behind ``count`` of the values or more."""
    for last, following in zip(values[count - 1 : -1], values[count:], strict=True):
        if following - last > GAP * max(abs(last), abs(following)):
            return float(0.5 * last + 0.5 * following)
    return math.inf
