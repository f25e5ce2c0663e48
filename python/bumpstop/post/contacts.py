"""Impacts as they are counted: above a threshold, rebounds merged by a rest time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray, not_negative
from bumpstop.errors import InputError
from bumpstop.post.impacts import impacts_of
from bumpstop.post.of_run import of_run
from bumpstop.post.peaks import largest_forces
from bumpstop.post.quadrature import integrals, kinks
from bumpstop.post.spans import Spans, cut_spans, is_loaded, state_spans
from bumpstop.quantities import COUNTED_IMPACTS

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from bumpstop.response import Response

__all__ = [
    "contact_forces",
    "contact_impacts",
    "counted_impacts",
    "labelled_columns",
    "loaded_spans",
]

Index: TypeAlias = NDArray[np.intp]
DIRECTIONS = ("normal", "around", "axial")
"""Along the normal of a contact, and the two across it."""
GRID = 65
"""Points of a smooth stretch of a contact at which crossings of the threshold are looked for."""
BISECTIONS = 54
"""Halvings of a step of that grid: what is left is rounding."""


def contact_forces(response: Response, stop: str) -> xr.DataArray:
    """Return the forces of a stop by directions of its contact; see `Response.contact_forces`."""
    import xarray as xr

    from bumpstop.labelled import time_coordinate

    law = response.law_index(stop)
    return xr.DataArray(
        response.history.contact_forces(law, response.times),
        dims=("time", "direction"),
        coords={"time": time_coordinate(response.times), "direction": list(DIRECTIONS)},
        name="contact_forces",
        attrs={"units": "N", "long_name": "force of the contact on the structure", "stop": stop},
    )


@of_run
def contact_impacts(
    response: Response, stop: str, *, threshold: float = 0.0, rest: float = 0.0
) -> pd.DataFrame:
    """Return the impacts on a stop as statistics count them.

    An impact begins when the force exceeds the threshold and ends when it is below it again.
    Where it exceeds it anew within the rest time, that is a rebound of the same impact. The
    damper of a stop may hold back its push before the gap opens: without threshold an impact
    ends there, and where the stop pushes again in the same closing of its gap, one begins.

    Parameters
    ----------
    response
        The run.
    stop
        Name of the stop.
    threshold
        Force in N; a crossing and return within a sixty-fourth of a smooth stretch of a contact
        may be passed over, the peak of a contact never is.
    rest
        Time in s for which a stop must be unloaded before another impact is counted.

    Returns
    -------
    pandas.DataFrame
        ``start end duration contact_time rebounds closing_speed peak_time peak_force impulse``,
        units in its ``attrs``. The impulse is that of the force while it exceeds the threshold;
        the closing speed is that at the start, negative where the gap opens then; ``end`` and
        ``duration`` are NaN while the last one lasts.

    Raises
    ------
    InputError
        If there is no such stop, or a number is negative.

    Examples
    --------
    >>> import bumpstop as bs
    >>> basis = bs.ModalBasis.from_modes(frequency=[0.0], shapes={("P", "dx"): [1.0]})
    >>> wall = bs.Stop("wall", node="P", normal=(1, 0, 0), gap=0.0, stiffness=1e4)
    >>> thrown = bs.ModalState(velocity=[-0.5])
    >>> run = bs.simulate(bs.Problem(basis, laws=[wall], initial=thrown, duration=0.1))
    >>> float(bs.contact_impacts(run, "wall").impulse[0].round(12))
    1.0
    """
    return labelled_columns(counted_impacts(response, stop, threshold=threshold, rest=rest))


def labelled_columns(columns: dict[str, FloatArray]) -> pd.DataFrame:
    """Return columns of counted impacts as a table with units in its attributes."""
    import pandas as pd

    table = pd.DataFrame(columns)
    table.attrs["units"] = {name: COUNTED_IMPACTS[name].units for name in columns}
    table.attrs["long_name"] = {name: COUNTED_IMPACTS[name].long_name for name in columns}
    return table


def counted_impacts(
    response: Response, stop: str, *, threshold: float = 0.0, rest: float = 0.0
) -> dict[str, FloatArray]:
    """Return the columns of `contact_impacts` as plain arrays."""
    law = response.stop_index(stop)
    spans = loaded_spans(response, stop, threshold)
    first = _firsts(spans, not_negative("rest", rest))
    peaks, peak_times, impulses, speeds = _told(response, law, spans, threshold)
    last = np.append(first[1:], len(spans.starts)) - 1 if len(first) else first
    ends = spans.ends[last].copy()
    unfinished = _force(response, law, np.array([response.problem.duration]))[0] > threshold
    if len(ends) and unfinished and ends[-1] >= response.problem.duration:
        ends[-1] = np.nan
    highest = [int(np.argmax(part)) for part in _groups(peaks, first)]
    at = first + np.array(highest, dtype=np.intp)
    return {
        "start": spans.starts[first],
        "end": ends,
        "duration": ends - spans.starts[first],
        "contact_time": _sums(spans.ends - spans.starts, first),
        "rebounds": _sums(np.ones(len(spans.starts)), first) - 1.0,
        "closing_speed": speeds[first],
        "peak_time": peak_times[at],
        "peak_force": peaks[at],
        "impulse": _sums(impulses, first),
    }


def loaded_spans(response: Response, stop: str, threshold: float) -> Spans:
    """Return when the force of a stop exceeds a threshold in N.

    Raises
    ------
    InputError
        If there is no such stop, or the threshold is negative.
    """
    law = response.stop_index(stop)
    not_negative("threshold", threshold)
    contacts = impacts_of(response, law)
    ends = np.where(np.isnan(contacts["end"]), response.problem.duration, contacts["end"])
    if threshold == 0.0:
        # Impacts on rigid stops take no time: their states tell of rests alone.
        if hasattr(response.problem.laws[law], "restitution"):
            return Spans(contacts["start"], ends)
        return state_spans(response, law, is_loaded)
    if np.isinf(contacts["peak_force"]).any():
        what = "means nothing for a rigid stop, whose impacts have no finite force"
        raise InputError(what, key="threshold", value=threshold)
    hard = contacts["peak_force"] > threshold
    columns = (contacts["start"][hard], contacts["peak_time"][hard], ends[hard])
    cuts = kinks(response)
    found = []
    for start, peak, end in zip(*columns, strict=True):
        marks = np.unique([start, peak, end, *_inside(cuts, start, end)])
        found.append(_crossings(response, law, marks, threshold))
    joined = np.concatenate([np.empty((0, 2)), *found])
    return Spans(joined[:, 0], joined[:, 1])


def _told(
    response: Response, law: int, spans: Spans, threshold: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return peaks in N, their times in s, impulses in N s and closing speeds in m/s, (n,) each.

    Of a whole contact they are the core's; of its parts they are found here.
    """
    contacts = impacts_of(response, law)
    if hasattr(response.problem.laws[law], "restitution"):
        # A rest may begin with the last blow, at the same instant.
        owner, whole = np.arange(len(spans.starts)), np.full(len(spans.starts), fill_value=True)
    else:
        owner = np.searchsorted(contacts["start"], spans.starts, side="right") - 1
        whole = np.bincount(owner, minlength=1)[owner] == 1
        whole &= threshold == 0.0
    names = ("peak_force", "peak_time", "impulse", "closing_speed")
    told = [contacts[name][owner] for name in names]
    parts = Spans(spans.starts[~whole], spans.ends[~whole])
    if len(parts.starts):
        found = [
            *largest_forces(response, law, parts),
            integrals_between(response, law, parts)[:, 0],
            -response.history.law_motion(law, parts.starts)[1],
        ]
        for column, values in zip(told, found, strict=True):
            column[~whole] = values
    peaks, times, impulses, speeds = told
    return peaks, times, impulses, speeds


def integrals_between(response: Response, law: int, spans: Spans) -> FloatArray:
    """Return the integrals of force and squared force over intervals, (n, 2), N s and N2 s."""
    return integrals_of(
        response, spans, lambda t: np.stack([f := _force(response, law, t), f * f], axis=1)
    )


def integrals_of(
    response: Response,
    spans: Spans,
    function: Callable[[FloatArray], FloatArray],
    tolerance: float = 1e-11,
) -> FloatArray:
    """Return integrals (n, K) over intervals of what has kinks where the response has."""
    cuts = kinks(response)
    (starts, ends), owner = cut_spans(spans, cuts)
    pieces = integrals(function, starts, ends, tolerance)
    total = np.zeros((len(spans.starts), pieces.shape[1]))
    np.add.at(total, owner, pieces)
    return total


def _crossings(response: Response, law: int, marks: FloatArray, threshold: float) -> FloatArray:
    """Return the intervals (n, 2) of one contact in which the force exceeds the threshold.

    The marks are its start and end, its peak, and where the force may have kinks.
    """
    grid = np.unique(np.concatenate([np.linspace(*pair, GRID) for pair in _pairs(marks)]))
    above = _force(response, law, grid) > threshold
    change = np.flatnonzero(above[1:] != above[:-1])
    low, high = grid[change], grid[change + 1]
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        same = (_force(response, law, middle) > threshold) == above[change]
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    edges = [*marks[:1][above[:1]], *high, *marks[-1:][above[-1:]]]
    return np.array(edges).reshape(-1, 2)


def _inside(cuts: FloatArray, start: float, end: float) -> FloatArray:
    return cuts[np.searchsorted(cuts, start, "right") : np.searchsorted(cuts, end, "left")]


def _firsts(spans: Spans, rest: float) -> Index:
    """Return which intervals begin a new impact."""
    if not len(spans.starts):
        return np.empty(0, dtype=np.intp)
    pause = spans.starts[1:] - spans.ends[:-1]
    return np.flatnonzero(np.concatenate([[True], pause >= rest]))


def _sums(values: FloatArray, first: Index) -> FloatArray:
    sums: FloatArray = np.add.reduceat(values, first) if len(first) else np.empty(0)
    return sums


def _groups(values: FloatArray, first: Index) -> Sequence[FloatArray]:
    return np.split(values, first[1:]) if len(first) else []


def _pairs(marks: FloatArray) -> list[tuple[float, float]]:
    return list(zip(marks[:-1].tolist(), marks[1:].tolist(), strict=True))


def _force(response: Response, law: int, times: FloatArray) -> FloatArray:
    return response.history.law_motion(law, times)[2]
