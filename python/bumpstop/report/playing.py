"""How a motion is played: its frames, how fast it goes, and how much it is magnified."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.response import Response

__all__ = ["frame_times", "magnifications", "paces"]

MOST_NUMBERS = 120_000
"""Numbers in all frames of a motion; it keeps the page small."""

_NICE = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10_000, 100_000, 1_000_000]


def frame_times(response: Response, most: int | None = None) -> FloatArray:
    """Return instants evenly spread over the run, in s: more of them where there are more impacts.

    Of a response that was read from a file they are among its own.
    """
    problem = response.problem
    numbers = len(problem.basis.omega2) + 2 * len(problem.laws) + 2
    wanted = max(1000, 40 * len(response.impact_table()["start"]))
    frames = min(wanted, max(MOST_NUMBERS // numbers, 200))
    if most is not None:
        frames = min(frames, most)
    if response.is_dense:
        return np.linspace(0.0, problem.duration, frames + 1)
    return response.instants[:: max(-(-len(response.instants) // frames), 1)]


def magnifications(extent: float, furthest: float) -> dict[str, Any]:
    """Return by how much the motion may be magnified, and by how much it is at first.

    Parameters
    ----------
    extent
        Size of the structure in m; zero where it has none.
    furthest
        How far any point moves, in m.

    Examples
    --------
    >>> magnifications(1.0, 0.02)
    {'choices': [1, 2, 5, 10, 20], 'first': 3}
    """
    if extent == 0.0 or furthest == 0.0:
        return {"choices": [1], "first": 0}
    choices = [factor for factor in _NICE if factor * furthest <= 0.6 * extent] or [1]
    fitting = [i for i, factor in enumerate(choices) if factor * furthest <= 0.3 * extent]
    return {"choices": choices, "first": fitting[-1] if fitting else 0}


def paces(response: Response) -> dict[str, Any]:
    """Return how many seconds on the screen one second of the run may take."""
    impacts = len(response.impact_table()["start"])
    screen_seconds = min(max(8.0, 0.8 * impacts), 600.0)
    usual = _nice_pace(screen_seconds / response.problem.duration)
    choices = [usual * factor for factor in (8.0, 4.0, 2.0, 1.0, 0.5, 0.25)]
    return {
        "choices": [{"slowdown": pace, "label": _pace_label(pace)} for pace in choices],
        "first": 3,
    }


def _nice_pace(slowdown: float) -> float:
    power = 10.0 ** np.floor(np.log10(slowdown))
    return float(power * min((1.0, 2.0, 4.0, 8.0, 10.0), key=lambda n: abs(n - slowdown / power)))


def _pace_label(slowdown: float) -> str:
    if slowdown == 1.0:
        return "real time"
    return f"{slowdown:,.6g} × slower" if slowdown > 1.0 else f"{1.0 / slowdown:,.6g} × faster"
