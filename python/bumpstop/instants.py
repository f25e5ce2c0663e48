"""Instants at which a response is tabulated: evenly spaced ones need no memory."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, overload

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

__all__ = ["SNAP", "Grid", "checked_times"]

ROUNDING = 1e-12
"""How far beyond the simulated time an instant may lie, relative to the duration."""
SNAP = 1e-6
"""A duration this close to a whole number of steps, in steps, is taken as whole."""


@dataclass(frozen=True)
class Grid:
    """The instants 0, step, 2 step, ... and always the end, last.

    Parameters
    ----------
    step
        Their interval in s.
    end
        The last one in s.

    Examples
    --------
    >>> grid = Grid(step=0.25, end=0.6)
    >>> len(grid), grid[1:].tolist()
    (4, [0.25, 0.5, 0.6])
    """

    step: float
    end: float

    def __len__(self) -> int:
        ratio = self.end / self.step
        whole = round(ratio)
        return 1 + (whole if abs(ratio - whole) <= SNAP else int(ratio) + 1)

    @overload
    def __getitem__(self, place: int) -> float: ...
    @overload
    def __getitem__(self, place: slice) -> FloatArray: ...
    def __getitem__(self, place: int | slice) -> float | FloatArray:
        count = len(self)
        numbers = range(count)[place]
        if isinstance(numbers, int):
            return self.end if numbers == count - 1 else numbers * self.step
        instants = np.arange(numbers.start, numbers.stop, numbers.step, dtype=np.float64)
        instants *= self.step
        if count - 1 in numbers:
            instants[numbers.index(count - 1)] = self.end
        instants.flags.writeable = False
        return instants


def checked_times(times: ArrayLike, duration: float) -> FloatArray:
    """Return instants as an array; those beyond an end by rounding alone are put on it.

    Raises
    ------
    InputError
        If they are no list of numbers, or one lies outside the simulated time.
    """
    try:
        given = np.array(times, ndmin=1)
        instants = given.astype(np.float64)
    except (TypeError, ValueError) as error:
        raise InputError("must be numbers", key="times", value=times) from error
    if given.dtype.kind in "US":
        raise InputError("must be numbers, not text", key="times", value=times)
    if instants.ndim != 1:
        raise InputError("must be a list of instants", key="times", value=times)
    outside = ~((instants >= -ROUNDING * duration) & (instants <= (1.0 + ROUNDING) * duration))
    if outside.any():
        what = f"must lie within the simulated time, 0 to {duration:g} s"
        raise InputError(what, key="times", value=float(instants[outside][0]))
    instants.clip(0.0, duration, out=instants)
    instants.flags.writeable = False
    return instants
