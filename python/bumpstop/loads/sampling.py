"""Straight lines through a function of time, as many as a tolerance asks for."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from bumpstop.arguments import FloatArray, positive
from bumpstop.errors import InputError, blamed
from bumpstop.loads.time import TimeTable

__all__ = ["MOST_KNOTS", "TOLERANCE", "checked_tolerance", "sampled", "too_many"]

TOLERANCE = 1e-4
"""Usual deviation of straight lines from a function, relative to its largest value."""
MOST_KNOTS = 2_000_000
"""A run with more phases than this would fill the memory."""
_INSIDE = np.array([0.27, 0.5, 0.76])
"""Parts of an interval at which its line is tried; not even, so that no wave hides between."""
_SEEN = 0.7
"""The part of a kink's deviation that is seen at one of these places at least."""
_JUMP = 1e-9
"""A change within this part of the whole is a jump."""
_SAME = 1e-12
"""Values on both sides of a knot this close, relative to the largest, are the same."""
_GROWTH = 100.0
"""What is so much larger inside a jump than beside it grows without limit."""
_CLOSING = 40
"""Halvings from a jump's width to neighbouring numbers."""


def checked_tolerance(value: object) -> float:
    """Return a relative tolerance above zero and below one."""
    tolerance = positive("tolerance", value)
    if tolerance >= 1.0:
        raise InputError("must be less than 1", key="tolerance", value=value)
    return tolerance


def sampled(
    function: Callable[[FloatArray], FloatArray],
    grid: FloatArray,
    tolerance: float,
    key: str = "time",
) -> TimeTable:
    """Return a table whose lines stay as close to a function as a tolerance says.

    Intervals are halved until the function at three places inside is that close to the line. For
    a smooth function the middle shows the whole error, h^2 |f''| / 8; what is quicker than the
    grid can hide. A change that halving does not resolve becomes a jump.

    Parameters
    ----------
    function
        Values at times; at a jump the one after it.
    grid
        Times (K,) in s, ascending, between which the search starts; jumps and kinks that are
        known among them.
    tolerance
        Largest deviation, relative to the largest value.
    key
        Argument of a load that is blamed for a function without finite values.

    Raises
    ------
    InputError
        If it takes more than two million lines, a value is not finite, or it grows without limit.

    Examples
    --------
    >>> table = sampled(np.sin, np.linspace(0.0, 6.0, 7), 1e-3)
    >>> times = np.linspace(0.0, 6.0, 1000)
    >>> bool(np.abs(table.at(times) - np.sin(times)).max() < 1e-3)
    True
    """
    begin, end = grid[:-1], grid[1:]
    finite = partial(_finite, function, key)
    first, last = finite(begin), finite(np.nextafter(end, -np.inf))
    largest = max(np.abs(first).max(), np.abs(last).max())
    width = _JUMP * (grid[-1] - grid[0])
    done: list[FloatArray] = []
    while len(begin):
        inside = begin[:, np.newaxis] + (end - begin)[:, np.newaxis] * _INSIDE
        values = finite(inside)
        largest = max(largest, np.abs(values).max())
        lines = first[:, np.newaxis] + (last - first)[:, np.newaxis] * _INSIDE
        far = np.abs(values - lines).max(axis=1) > _SEEN * tolerance * largest
        jumps = far & (end - begin < width)
        with blamed(key):
            _refuse_poles(function, begin[jumps], end[jumps], grid)
        last = np.where(jumps, first, last)
        split = far & ~jumps
        done.append(np.stack([begin, end, first, last], axis=1)[~split])
        if sum(map(len, done)) + 2 * np.count_nonzero(split) > MOST_KNOTS:
            raise too_many(tolerance)
        middle = inside[split, 1]
        at_middle = values[split, 1]
        begin, end = np.concatenate([begin[split], middle]), np.concatenate([middle, end[split]])
        first = np.concatenate([first[split], at_middle])
        last = np.concatenate([at_middle, last[split]])
    return _table(np.concatenate(done), float(largest))


def too_many(tolerance: float) -> InputError:
    """Return the error that says that a function needs too many lines."""
    return InputError(
        f"needs more than {MOST_KNOTS:,} straight lines",
        key="time.tolerance",
        value=tolerance,
        hint="take a larger one, or a shorter run",
    )


def _table(lines: FloatArray, largest: float) -> TimeTable:
    """Return the table of lines (begin, end, first, last), with two values where they jump."""
    begin, end, first, last = lines[np.argsort(lines[:, 0], kind="stable")].T
    jump = np.append(np.abs(last[:-1] - first[1:]) > _SAME * largest, True)
    times = np.stack([begin, end], axis=1).ravel()
    values = np.stack([first, last], axis=1).ravel()
    keep = np.stack([np.ones(len(begin), dtype=bool), jump], axis=1).ravel()
    return TimeTable(times[keep], values[keep], beyond="hold")


def _refuse_poles(
    function: Callable[[FloatArray], FloatArray],
    begin: FloatArray,
    end: FloatArray,
    grid: FloatArray,
) -> None:
    """Raise where a function grows without limit in intervals that look like jumps.

    They close in on the largest value: beside a jump it stays as large as it was outside.
    """
    if len(begin) == 0:
        return
    width = end - begin
    beside = np.stack([begin - width, end + width])
    inside_run = (grid[0] <= beside) & (beside <= grid[-1])
    outside = np.where(inside_run, _sizes(function, np.clip(beside, grid[0], grid[-1])), 0.0)
    left, right, largest = begin, end, np.zeros(len(begin))
    for _ in range(_CLOSING):
        places = np.linspace(left, np.nextafter(right, -np.inf), 5)
        sizes = _sizes(function, places)
        largest = np.maximum(largest, sizes.max(axis=0))
        at = np.clip(sizes.argmax(axis=0), 1, 3)
        left, right = (np.choose(at + side, places) for side in (-1, 1))
    poles = largest > _GROWTH * outside.max(axis=0)
    if poles.any():
        where, hint = f"t = {left[poles][0]:.9g} s", "a load must be finite at every instant"
        raise InputError("grows without limit", value=where, hint=hint)


def _sizes(function: Callable[[FloatArray], FloatArray], times: FloatArray) -> FloatArray:
    """Return magnitudes; zero where there is none, as at the instant of a jump |x| / x."""
    return np.nan_to_num(np.abs(_raw(function, times)), nan=0.0, posinf=np.inf)


def _raw(function: Callable[[FloatArray], FloatArray], times: FloatArray) -> FloatArray:
    with np.errstate(all="ignore"):
        return np.broadcast_to(function(times), times.shape).astype(np.float64)


def _finite(
    function: Callable[[FloatArray], FloatArray], key: str, times: FloatArray
) -> FloatArray:
    values = _raw(function, times)
    wrong = ~np.isfinite(values)
    if wrong.any():
        raise InputError("has no finite value", key=key, value=f"t = {times[wrong][0]:.9g} s")
    return values
