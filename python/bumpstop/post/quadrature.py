"""Integrals over time of what a response can be asked for at any instant."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray

if TYPE_CHECKING:
    from bumpstop.loads.time import TimeTable
    from bumpstop.problem import Problem
    from bumpstop.response import Response

__all__ = ["integrals", "kinks"]

POINTS = 16
"""Gauss-Legendre points of a piece: exact for polynomials of degree 31."""
DEEPEST = 24
"""So many times a piece is halved at most; a kink left inside is then of no account."""


def integrals(
    function: Callable[[FloatArray], FloatArray],
    starts: FloatArray,
    ends: FloatArray,
    tolerance: float = 1e-11,
) -> FloatArray:
    """Integrate functions of time over intervals, by halving until the halves agree.

    Parameters
    ----------
    function
        Returns values (n, K) at instants (n,).
    starts, ends
        The intervals, (m,) each, in s.
    tolerance
        What the sum of two halves may differ by from the whole, relative to the largest integral
        of the same function's magnitude over any of the intervals. The sum is taken, which is
        far better where functions are smooth; less than the rounding of the functions would
        only cut noise into pieces.

    Returns
    -------
    ndarray
        Integrals (m, K).

    Examples
    --------
    >>> found = integrals(lambda t: np.stack([np.sin(t)], axis=1), np.zeros(1), np.array([np.pi]))
    >>> bool(abs(found[0, 0] - 2.0) < 1e-15)
    True
    """
    owner = np.arange(len(starts))
    whole, size = _panels(function, starts, ends)
    total = np.zeros_like(whole)
    limit = tolerance * size.max(axis=0, initial=0.0)
    for _ in range(DEEPEST):
        if not len(owner):
            break
        middle = 0.5 * (starts + ends)
        left, _size = _panels(function, starts, middle)
        right, _size = _panels(function, middle, ends)
        halves = left + right
        done = np.all(np.abs(halves - whole) <= limit, axis=1)
        np.add.at(total, owner[done], halves[done])
        rest = ~done
        owner = np.tile(owner[rest], 2)
        starts, ends = (
            np.concatenate([starts[rest], middle[rest]]),
            np.concatenate([middle[rest], ends[rest]]),
        )
        whole = np.concatenate([left[rest], right[rest]])
    np.add.at(total, owner, whole)
    return total


def kinks(response: Response) -> FloatArray:
    """Return the instants in s at which derivatives of a response may jump, ascending.

    Switches of laws, knots of tables that loads and obstacles follow, and the steps of a
    fixed-step method.
    """
    times = [np.array(response.history.events()["time"], dtype=float)]
    problem = response.problem
    step = response.options.get("dt")
    if step is not None:
        times.append(np.arange(response.steps + 1) * step)
    times += [np.asarray(table.times) for table in _tables(problem)]
    found = np.unique(np.concatenate(times))
    inside: FloatArray = found[(found > 0.0) & (found < problem.duration)]
    return inside


def _tables(problem: Problem) -> list[TimeTable]:
    """Return the tables that obstacles and loads follow."""
    from bumpstop.loads.time import TimeTable, resolved

    followed = [getattr(law, "functions", ()) for law in problem.laws]
    for load in problem.loads:
        followed += [functions for _, functions in load.components(problem.basis)]
    terms = [term for each in followed for term in resolved(each, problem.duration)]
    return [term for term in terms if isinstance(term, TimeTable)]


@cache
def _rule() -> tuple[FloatArray, FloatArray]:
    """Return the nodes between -1 and 1 and their weights, found once."""
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    return nodes, weights


def _panels(
    function: Callable[[FloatArray], FloatArray], starts: FloatArray, ends: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return integrals by one panel each, and those of the magnitude, (m, K)."""
    nodes, weights = _rule()
    half = 0.5 * (ends - starts)
    times = (0.5 * (starts + ends))[:, np.newaxis] + half[:, np.newaxis] * nodes
    values = function(times.ravel())
    values = values.reshape(len(starts), POINTS, values.shape[1])
    scaled = half[:, np.newaxis, np.newaxis] * weights[:, np.newaxis] * values
    return scaled.sum(axis=1), np.abs(scaled).sum(axis=1)
