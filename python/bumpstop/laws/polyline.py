"""Forces that follow straight segments: what springs and dampers of several slopes share."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from bumpstop.arguments import FloatArray, pair, series
from bumpstop.errors import InputError

__all__ = ["checked_segments", "line_values", "slopes_through"]

MOST_SEGMENTS = 255


def checked_segments(
    key: str, slopes: Sequence[float], breaks: Sequence[float]
) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return slopes, called ``key``, and breaks that fit together.

    Raises
    ------
    InputError
        If a number is not finite, the breaks do not increase or do not fit the slopes.
    """
    known = series("breaks", breaks) if len(breaks) else ()
    checked = series(key, slopes)
    if len(checked) != len(known) + 1:
        hint = f"{len(known)} breaks part {len(known) + 1} segments"
        what = "must have one slope more than there are breaks"
        raise InputError(what, key=key, value=checked, hint=hint)
    if len(checked) > MOST_SEGMENTS:
        what = f"must not have more than {MOST_SEGMENTS} segments"
        raise InputError(what, key=key, value=len(checked))
    if any(after <= before for before, after in pairwise(known)):
        raise InputError("must increase", key="breaks", value=known)
    return checked, known


def slopes_through(
    points: Sequence[Sequence[float]], order: str
) -> tuple[tuple[float, ...], tuple[float, ...], float]:
    """Return slopes, breaks and the force at zero of a line through points (place, force).

    Raises
    ------
    InputError
        If there are fewer than two, or they are not in order of what is called ``order``.
    """
    pairs = np.array([pair(f"curve[{i}]", point) for i, point in enumerate(points)])
    if len(pairs) < 2:
        raise InputError("must have at least two points", key="curve", value=points)
    steps = np.diff(pairs, axis=0)
    if (steps[:, 0] <= 0.0).any():
        raise InputError(f"must be in the order of {order}", key="curve", value=points)
    slopes = steps[:, 1] / steps[:, 0]
    breaks = pairs[1:-1, 0]
    home = int(np.searchsorted(breaks, 0.0, side="right"))
    at_zero = float(pairs[home, 1] - slopes[home] * pairs[home, 0])
    return tuple(slopes.tolist()), tuple(breaks.tolist()), at_zero


def line_values(
    places: FloatArray | Sequence[float],
    slopes: Sequence[float],
    breaks: Sequence[float],
    at_zero: float,
) -> FloatArray:
    """Return the forces at some places."""
    x = np.asarray(places, dtype=np.float64)
    ends = np.array([-np.inf, *breaks, np.inf])
    total = np.full(x.shape, at_zero)
    for slope, low, high in zip(slopes, ends[:-1], ends[1:], strict=True):
        total += slope * (np.clip(x, low, high) - np.clip(0.0, low, high))
    return total
