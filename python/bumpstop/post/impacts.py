"""Tables of what happened: impacts and events."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from bumpstop.quantities import IMPACTS

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.response import Response

__all__ = ["Table", "event_table", "impact_table", "impacts_of"]

Table: TypeAlias = dict[str, list[str] | list[float] | list[int]]
"""Columns of equal length."""


def impact_table(response: Response) -> Table:
    """Return the contacts of all stops in the order of closing.

    An impact begins when the gap closes and ends when it opens again; a stop that is closed
    at t = 0 begins its first impact there.

    Returns
    -------
    dict
        ``stop`` and the columns of `bumpstop.quantities.IMPACTS`: times in s, speeds in m/s,
        force in N, impulse in N s, energy in J. ``end``, ``duration`` and ``opening_speed``
        are NaN while the stop is still closed at the end of the run.
    """
    stops = [law.name for law in response.problem.laws]
    tables = [impacts_of(response, index) for index in range(len(stops))]
    start = _joined([table["start"] for table in tables])
    owner = np.repeat(np.arange(len(stops)), [len(table["start"]) for table in tables])
    order = np.argsort(start, kind="stable")
    columns: Table = {"stop": [stops[index] for index in owner[order]]}
    for name in IMPACTS:
        columns[name] = _joined([table[name] for table in tables])[order].tolist()
    return columns


def impacts_of(response: Response, stop: int) -> dict[str, FloatArray]:
    """Return the impacts of one stop, counted from 0, in the order of closing.

    They are found once: the search for the peak of a long contact takes its time.
    """
    known = response.known_impacts
    if stop not in known:
        core = response.history.impacts(stop)
        # A stop that is closed from the start closes with the speed -0.0, which is 0.
        speed = core["closing_speed"] + 0.0
        known[stop] = core | {"closing_speed": speed, "duration": core["end"] - core["start"]}
    return known[stop]


def event_table(response: Response) -> Table:
    """Return every switch of a law: ``time`` in s, ``law``, ``guard``, ``before``, ``after``."""
    core = response.history.events()
    laws = [law.name for law in response.problem.laws]
    return {
        "time": core["time"],
        "law": [laws[int(index)] for index in core["law"]],
        "guard": core["guard"],
        "before": core["before"],
        "after": core["after"],
    }


def _joined(columns: list[FloatArray]) -> FloatArray:
    return np.concatenate([np.empty(0), *columns])
