"""Intervals of time in which a law is in some of its states."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray

if TYPE_CHECKING:
    from bumpstop.response import Response

__all__ = ["FREE", "Spans", "cut_spans", "is_loaded", "spans_within", "state_spans"]

FREE = ("open", "released")
"""States in which a stop makes no force; released, its damper holds back the spring's push."""


def is_loaded(state: str) -> bool:
    """Return whether a stop makes a force in a state; some tell their side after a comma."""
    return state.partition(",")[0] not in FREE


class Spans(NamedTuple):
    """Intervals of time, apart from each other, ascending."""

    starts: FloatArray
    """In s, (n,)."""
    ends: FloatArray
    """In s, (n,); the end of the run where an interval lasts then."""


def state_spans(response: Response, law: int, wanted: Callable[[str], bool]) -> Spans:
    """Return the intervals in which the state of a law, counted from 0, is a wanted one.

    They begin and end at switches of the law, at the start and at the end of the run.
    """
    history = response.history
    events = history.events()
    own = np.flatnonzero(np.asarray(events["law"], dtype=np.intp) == law).tolist()
    # A law may switch at t = 0 itself: what it was in before tells how the run begins.
    first = events["before"][own[0]] if own else history.law_states(law, np.zeros(1))[0]
    states = [str(first), *(str(events["after"][number]) for number in own)]
    marks = np.array([0.0, *(events["time"][number] for number in own), history.duration])
    inside = np.concatenate([[False], [wanted(state) for state in states], [False]])
    inside[1:-1] &= marks[1:] > marks[:-1]
    change = np.flatnonzero(inside[1:] != inside[:-1])
    return Spans(marks[change[::2]], marks[change[1::2]])


def spans_within(spans: Spans, first: float, last: float) -> Spans:
    """Return what of some intervals is between two instants."""
    starts, ends = spans.starts.clip(first, last), spans.ends.clip(first, last)
    inside = ends > starts
    return Spans(starts[inside], ends[inside])


def cut_spans(spans: Spans, cuts: FloatArray) -> tuple[Spans, NDArray[np.intp]]:
    """Return the pieces of intervals between cuts, and which interval each is of."""
    low = np.searchsorted(cuts, spans.starts, side="right")
    high = np.maximum(np.searchsorted(cuts, spans.ends, side="left"), low)
    inner = high - low
    owner = np.repeat(np.arange(len(inner)), inner + 1)
    last = np.cumsum(inner + 1)
    first = last - (inner + 1)
    within = np.arange(len(owner)) - first[owner]
    index = low[owner] + within
    padded = np.append(cuts, np.nan)
    starts = np.where(within == 0, spans.starts[owner], padded[index - 1])
    ends = np.where(within == inner[owner], spans.ends[owner], padded[index])
    return Spans(starts, ends), owner
