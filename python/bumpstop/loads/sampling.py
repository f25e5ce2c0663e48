"""Straight lines through a function of time, as many as a tolerance asks for."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from bumpstop.arguments import FloatArray, positive
from bumpstop.errors import InputError
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


def checked_tolerance(value: object) -> float:
    """Return a relative tolerance above zero and below one."""
    tolerance = positive("tolerance", value)
    if tolerance >= 1.0:
        raise InputError("must be less than 1", key="tolerance", value=value)
    return tolerance


def sampled(
    function: Callable[[FloatArray], FloatArray], grid: FloatArray, tolerance: float
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

    Raises
    ------
    InputError
        If it takes more than two million lines, or a value is not finite.

    Examples
    --------
    >>> table = sampled(np.sin, np.linspace(0.0, 6.0, 7), 1e-3)
    >>> times = np.linspace(0.0, 6.0, 1000)
    >>> bool(np.abs(table.at(times) - np.sin(times)).max() < 1e-3)
    True
    """
    begin, end = grid[:-1], grid[1:]
    first, last = _values(function, begin), _values(function, np.nextafter(end, -np.inf))
    largest = max(np.abs(first).max(), np.abs(last).max())
    width = _JUMP * (grid[-1] - grid[0])
    done: list[FloatArray] = []
    while len(begin):
        inside = begin[:, np.newaxis] + (end - begin)[:, np.newaxis] * _INSIDE
        values = _values(function, inside)
        largest = max(largest, np.abs(values).max())
        lines = first[:, np.newaxis] + (last - first)[:, np.newaxis] * _INSIDE
        far = np.abs(values - lines).max(axis=1) > _SEEN * tolerance * largest
        jumps = far & (end - begin < width)
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
        key="tolerance",
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


def _values(function: Callable[[FloatArray], FloatArray], times: FloatArray) -> FloatArray:
    with np.errstate(all="ignore"):
        values = np.broadcast_to(function(times), times.shape).astype(np.float64)
    wrong = ~np.isfinite(values)
    if wrong.any():
        raise InputError("has no finite value", key="time", value=f"t = {times[wrong][0]:.9g} s")
    return values
