"""SciPy's solution of equations that change at events, stretch by stretch."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp


class Change(NamedTuple):
    """Where a stretch ends: a function that goes through zero in a direction, and what follows."""

    function: Callable[[Any], float]
    direction: float
    follows: Callable[[Any], Stretch]


class Stretch(NamedTuple):
    """Rates of a state y at a time, and what ends them."""

    rates: Callable[[float, Any], Any]
    changes: list[Change]


def in_stretches(first: Stretch, start: list[float], times: Any) -> Any:
    """Return the states at some times, the first of them that of the start, (time, state)."""
    stretch, begun, state = first, float(times[0]), np.array(start)
    found = [state]
    for _ in range(1000):
        left = times[len(found) :]
        if not len(left):
            return np.array(found)
        events = []
        for change in stretch.changes:

            def event(_: float, y: Any, change: Change = change) -> float:
                return change.function(y)

            event.terminal, event.direction = True, change.direction  # type: ignore[attr-defined]
            events.append(event)
        run = solve_ivp(
            stretch.rates,
            (begun, float(times[-1])),
            state,
            "DOP853",
            dense_output=True,
            events=events,
            rtol=1e-12,
            atol=1e-14,
            max_step=2e-2 * float(times[-1]),
        )
        end = float(run.t[-1])
        found += [run.sol(t) for t in left[left <= end]]
        begun, state = end, run.y[:, -1]
        for change, hits in zip(stretch.changes, run.t_events, strict=True):
            if len(hits):
                stretch = change.follows(state)
                break
    raise AssertionError("too many stretches")
