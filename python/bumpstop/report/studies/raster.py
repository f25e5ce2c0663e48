"""Many points as a picture of how many lie in each pixel."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray

__all__ = ["Raster", "rastered"]

COLUMNS = 1000
ROWS = 600
_BLOCK = 1 << 20
"""Points that are put into pixels at a time: memory does not grow with how many there are."""


class Raster(NamedTuple):
    """How many points lie in each pixel."""

    counts: NDArray[np.int64]
    """(row, column), the lowest row first."""
    x: FloatArray
    """The middle of each column."""
    y: FloatArray
    """The middle of each row."""
    some: NDArray[np.int64]
    """One of the points in each pixel; -1 where there is none."""


def rastered(x: FloatArray, y: FloatArray, rows: int = ROWS, columns: int = COLUMNS) -> Raster:
    """Put points into pixels; those that are not finite are left out.

    Where there are few different x, as in a diagram over the values of a parameter, each is a
    column of its own.

    Parameters
    ----------
    x, y
        The points.
    rows, columns
        How many pixels high and, at most, wide the picture is.

    Examples
    --------
    >>> rastered(np.array([0.0, 0.0, 1.0]), np.array([0.0, 2.0, 2.0]), rows=2).counts
    array([[1, 0],
           [1, 1]])
    """
    finite = np.isfinite(x) & np.isfinite(y)
    levels = _few_levels(x[finite], columns)
    across = _Bins(x[finite], columns) if levels is None else None
    columns = columns if levels is None else len(levels)
    up = _Bins(y[finite], rows)
    counts = np.zeros(rows * columns, dtype=np.int64)
    some = np.full(rows * columns, -1, dtype=np.int64)
    for start in range(0, len(x), _BLOCK):
        part = slice(start, start + _BLOCK)
        known = finite[part]
        xs, ys = x[part][known], y[part][known]
        column = across.numbers(xs) if across else np.searchsorted(np.asarray(levels), xs)
        pixel = up.numbers(ys) * columns + column
        counts += np.bincount(pixel, minlength=rows * columns)
        some[pixel] = start + np.flatnonzero(known)
    middles = across.middles if across else np.asarray(levels, dtype=float)
    shape = (rows, columns)
    return Raster(counts.reshape(shape), middles, up.middles, some.reshape(shape))


class _Bins:
    """Classes of equal width over a range of values."""

    def __init__(self, values: FloatArray, number: int) -> None:
        low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 1.0)
        # Something that is the same throughout lies in the middle of a range.
        margin = 0.0 if high > low else max(abs(low), 1.0) * 1e-6
        self._low, self._number = low - margin, number
        self._width = (high - low + 2.0 * margin) / number

    @property
    def middles(self) -> FloatArray:
        """The middle of each class."""
        return self._low + self._width * (np.arange(self._number, dtype=np.float64) + 0.5)

    def numbers(self, values: FloatArray) -> NDArray[np.int64]:
        """Return in which class values lie."""
        numbers = ((values - self._low) / self._width).astype(np.int64)
        return numbers.clip(0, self._number - 1)


def _few_levels(values: FloatArray, columns: int) -> FloatArray | None:
    """Return the different values, ascending; None where there are more than columns."""
    if len(np.unique(values[:: max(len(values) // (8 * columns), 1)])) > columns:
        return None
    levels = np.unique(values)
    return levels if len(levels) <= columns else None
