"""The largest force of a stop within intervals."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray
from bumpstop.laws.stop import Stop
from bumpstop.post.spans import Spans

if TYPE_CHECKING:
    from bumpstop.response import Response

__all__ = ["largest_forces"]

LOOKS = 64
"""Steps of a stretch at whose ends the force is looked at, the more stretches the longer it is."""
PERIODS = 8.0
"""Of the fastest motion in contact, in a stretch at most."""
NEAR = 0.25
"""Maxima of the grid that are this part of the force's range below the largest are looked at
closer: of a sine that is met eight times a period, the largest value found may be 4 % of the range
too low."""
CLOSER, FINER = 16, 9
"""Steps of each finer grid about a maximum, and how many there are: what is left is rounding."""


def largest_forces(response: Response, law: int, spans: Spans) -> tuple[FloatArray, FloatArray]:
    """Return the largest force of a law in N within each interval, and when, (n,) each.

    It is looked for on a grid of eight points or more for a period of the fastest motion that
    the modes with the stop have, and about the large ones of this grid by finer grids.
    """
    if not len(spans.starts):
        return np.empty(0), np.empty(0)
    low, high, owner = _large(response, law, spans)
    for _ in range(FINER):
        low, high, best, force = _closer(response, law, low, high)
    order = np.lexsort((force, owner))
    last = order[np.flatnonzero(np.append(owner[1:] != owner[:-1], True))]
    return force[last], best[last]


def _large(
    response: Response, law: int, spans: Spans
) -> tuple[FloatArray, FloatArray, NDArray[np.intp]]:
    """Return the neighbourhoods of large maxima on a grid, and which interval each is of."""
    pieces = np.ceil((spans.ends - spans.starts) / _stretch(response, law)).clip(min=1.0)
    steps = LOOKS * pieces.astype(np.intp)
    owner = np.repeat(np.arange(len(steps)), steps + 1)
    first = np.cumsum(steps + 1) - (steps + 1)
    within = np.arange(len(owner)) - first[owner]
    times = spans.starts[owner] + (spans.ends - spans.starts)[owner] * (within / steps[owner])
    np.minimum(times, spans.ends[owner], out=times)
    force = response.history.law_motion(law, times)[2]
    begins, ends = within == 0, within == steps[owner]
    # Of a plateau the first alone is one.
    maxima = begins | (force > np.roll(force, 1))
    maxima &= ends | (force >= np.roll(force, -1))
    highest, lowest = np.maximum.reduceat(force, first), np.minimum.reduceat(force, first)
    maxima &= force >= (highest - NEAR * (highest - lowest))[owner]
    at = np.flatnonzero(maxima)
    return times[at - ~begins[at]], times[at + ~ends[at]], owner[at]


def _closer(
    response: Response, law: int, low: FloatArray, high: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return closer neighbourhoods of the largest forces of some, when these are, and these."""
    part = np.linspace(0.0, 1.0, CLOSER + 1)
    times = low[:, np.newaxis] + (high - low)[:, np.newaxis] * part
    np.minimum(times, high[:, np.newaxis], out=times)
    values = response.history.law_motion(law, times.ravel())[2].reshape(times.shape)
    at = values.argmax(axis=1)
    row = np.arange(len(low))
    around = times[row, np.maximum(at - 1, 0)], times[row, np.minimum(at + 1, CLOSER)]
    return *around, times[row, at], values[row, at]


def _stretch(response: Response, law: int) -> float:
    """Return the longest stretch in s of one grid."""
    basis, stop = response.problem.basis, response.problem.laws[law]
    square = float(basis.omega2.max())
    if isinstance(stop, Stop):
        # No eigenvalue of diag(omega2) + k r r^T is above this (H. Weyl).
        row = stop.row(basis)
        square += stop.stiffness * float(row @ row)
    return PERIODS * 2.0 * math.pi / math.sqrt(square) if square > 0.0 else math.inf
