"""Curves with no more points than can be seen, and none of those that matter missing."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from bumpstop.arguments import FloatArray
    from bumpstop.response import Response

__all__ = ["MOST_POINTS", "contact_spans", "instants", "looked_at", "state_spans", "thin"]

MOST_POINTS = 2000
"""Points of one curve: more than a wide screen has columns."""
MOST_INSTANTS = 500_000
"""Instants at which a motion is looked at for a picture."""


def contact_spans(response: Response, stop: str | None = None) -> list[tuple[float, float]]:
    """Return when each impact began and ended, in s, of one stop or of all.

    An impact still under way at the end of the run ends there.
    """
    table = response.impact_table()
    wanted = [stop is None or name == stop for name in table["stop"]]
    starts = np.array(table["start"], dtype=float)[wanted]
    ends = np.array(table["end"], dtype=float)[wanted]
    ends[np.isnan(ends)] = response.problem.duration
    return list(zip(starts.tolist(), ends.tolist(), strict=True))


def state_spans(response: Response, law: str, state: str) -> list[tuple[float, float]]:
    """Return when a law was in a state, in s, by the events."""
    table = response.event_table()
    own = [n for n, name in enumerate(table["law"]) if name == law]
    times = [0.0, *(float(table["time"][n]) for n in own), response.problem.duration]
    first = table["before"][own[0]] if own else response.sample("state", law, times=[0.0])[0]
    states = [first, *(table["after"][n] for n in own)]
    spans = zip(states, times[:-1], times[1:], strict=True)
    return [(start, end) for name, start, end in spans if name == state and end > start]


def instants(response: Response, extra: Iterable[float] = ()) -> FloatArray:
    """Return the times at which a curve is looked at, ascending, in s.

    They are the sample grid and, where the motion between its instants is known, every instant at
    which a stop closes, presses hardest or opens (the kinks of the curves), and ``extra`` ones
    such as those of published values.
    """
    if not response.is_dense:
        return looked_at(response)
    table = response.impact_table()
    kinks = [*table["start"], *table["end"], *table["peak_time"]]
    added = np.array([*kinks, *extra], dtype=float)
    inside = (added >= 0.0) & (added <= response.problem.duration)
    return np.union1d(looked_at(response), added[inside])


def looked_at(response: Response) -> FloatArray:
    """Return the sample grid in s, or a coarser one where pictures do not need as many."""
    if len(response.instants) <= MOST_INSTANTS:
        return response.times
    if not response.is_dense:
        return response.instants[:: -(-len(response.instants) // MOST_INSTANTS)]
    return np.linspace(0.0, response.problem.duration, MOST_INSTANTS)


def thin(
    values: FloatArray, keep: NDArray[np.bool_] | None = None, at_most: int = MOST_POINTS
) -> NDArray[np.intp]:
    """Return the indices of the points to draw.

    The curve is cut into equal runs; the lowest and the highest point of each stay, so that
    no peak is lost, and so do the ends.

    Parameters
    ----------
    values
        One curve, (n,).
    keep
        Points that stay whatever happens, (n,); there may be more of them than ``at_most``.
    at_most
        How many points to draw.

    Examples
    --------
    >>> spike = np.zeros(10_000)
    >>> spike[1234] = 1.0
    >>> kept = thin(spike)
    >>> len(kept) <= 2000, 1234 in kept
    (True, True)
    """
    count = len(values)
    if count <= at_most:
        return np.arange(count)
    held = np.array([0, count - 1]) if keep is None else np.flatnonzero(keep)
    ends = np.union1d(held, [0, count - 1])
    runs = max((at_most - len(ends)) // 2, 1)
    starts = np.linspace(0, count, runs, endpoint=False).astype(np.intp)
    order = np.lexsort((values, np.repeat(np.arange(runs), np.diff([*starts, count]))))
    lowest = order[starts]
    highest = order[np.append(starts[1:], count) - 1]
    return np.unique(np.concatenate([ends, lowest, highest]))
