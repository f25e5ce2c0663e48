r"""Limits of sequences that refinement makes, with the order at which they are approached.

A quantity that converges regularly is :math:`v(s) = v_\infty + c\, s^{-p} + \ldots` in the size
:math:`s` of the model. From three sizes that double, the observed order is
:math:`p = \log_2 (v_1 - v_0)/(v_2 - v_1)`, and Richardson's extrapolation gives the limit
(P. J. Roache, "Perspective: a method for uniform reporting of grid refinement studies", Journal
of Fluids Engineering 116, 1994). Contact problems need not converge regularly: where the
differences change their sign or do not shrink steadily, there is no order, and the last
differences are all that is known of the error.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray

__all__ = ["Limit", "extrapolated", "orders_towards"]

LEAST_ORDER = 0.5
"""Differences that shrink more slowly tell nothing of where they lead."""
MOST_SPREAD = 1.0
"""Orders of one sequence that differ by more are no order."""
ROUNDING = 1e-10
"""Differences below this, relative to the values, are rounding."""


class Limit(NamedTuple):
    """Where sequences lead, each an array (n,)."""

    values: FloatArray
    uncertainty: FloatArray
    """How far the limit may be from that."""
    order: FloatArray
    """NaN where there is none to be seen."""


def extrapolated(rungs: FloatArray) -> Limit:
    """Return the limits of sequences whose size doubles from one to the next.

    Parameters
    ----------
    rungs
        Values, coarsest first, (sizes, n), two sizes or more.

    Returns
    -------
    Limit
        Of a regular sequence, Richardson's limit, uncertain by its distance from the finest
        value; of any other the finest value, uncertain by the larger of the last two
        differences.

    Examples
    --------
    >>> sizes = np.array([1.0, 2.0, 4.0, 8.0])
    >>> limit = extrapolated(3.0 + 5.0 * sizes[:, None] ** -2)
    >>> limit.values.round(12), limit.order.round(12)
    (array([3.]), array([2.]))
    """
    differences = np.diff(rungs, axis=0)
    order = _steady(_orders(differences, np.log(2.0)))
    still = np.abs(differences[-1]) <= ROUNDING * np.abs(rungs).max(axis=0)
    regular = ~np.isnan(order)
    # The last ratio of differences, and not one of the mean order: it is nearest to the limit.
    ratio = np.full(order.shape, np.inf)
    if regular.any():
        ratio[regular] = differences[-2][regular] / differences[-1][regular]
    step = differences[-1] / (ratio - 1.0)
    doubt = np.where(still, np.abs(differences[-1]), np.abs(differences[-2:]).max(axis=0))
    return Limit(
        values=rungs[-1] + np.where(regular, step, 0.0),
        uncertainty=np.where(regular, np.abs(step), doubt),
        order=order,
    )


def orders_towards(limit: FloatArray, sizes: Sequence[float], rungs: FloatArray) -> FloatArray:
    """Return the orders at which sequences approach limits that are known, (n,).

    Parameters
    ----------
    limit
        Where they lead, (n,).
    sizes
        Sizes of the model, ascending.
    rungs
        Values at these sizes, (sizes, n).

    Examples
    --------
    >>> rungs = np.array([[1.0 + 8.0], [1.0 + 1.0], [1.0 + 0.125]])
    >>> orders_towards(np.ones(1), [10, 20, 40], rungs)
    array([3.])
    """
    errors = rungs - limit
    small = np.abs(errors) <= ROUNDING * np.abs(rungs).max(axis=0, initial=0.0)
    errors[small] = np.nan
    return _steady(_orders(errors, np.diff(np.log(sizes))[:, np.newaxis]))


def _orders(parts: FloatArray, growth: FloatArray | float) -> FloatArray:
    """Return the orders at which what is left shrinks from size to size, (sizes - 1, n)."""
    with np.errstate(invalid="ignore", divide="ignore"):
        orders: FloatArray = np.log(parts[:-1] / parts[1:]) / growth
    return orders


def _steady(orders: FloatArray) -> FloatArray:
    """Return the mean order of each sequence; NaN where it is not one."""
    if not len(orders):
        return np.full(orders.shape[1], np.nan)
    # NaN compares as false: a sequence with one is not steady.
    steady = (orders.min(axis=0) >= LEAST_ORDER) & (np.ptp(orders, axis=0) <= MOST_SPREAD)
    return np.where(steady & np.isfinite(orders).all(axis=0), orders.mean(axis=0), np.nan)
