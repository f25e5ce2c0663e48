"""Impacts counted from samples of a force, as measurements and most programs have them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, not_negative, samples
from bumpstop.errors import InputError
from bumpstop.post.contacts import labelled_columns

if TYPE_CHECKING:
    import pandas as pd
    from numpy.typing import ArrayLike

    from bumpstop.response import Response

__all__ = ["impact_samples", "sampled_impacts", "samples_of"]


def sampled_impacts(
    times: ArrayLike,
    force: ArrayLike,
    closing_speed: ArrayLike | None = None,
    *,
    threshold: float = 0.0,
    rest: float = 0.0,
) -> pd.DataFrame:
    """Return the impacts in samples of a force.

    An impact is a run of samples above the threshold; runs with less than the rest time between
    them are rebounds of one impact. Its end is the first sample after it, its peak the largest
    sample, its impulse the sum of F_i (t_i+1 - t_i-1) / 2, its closing speed that at its first
    sample. These are the definitions of POST_DYNA_MODA_T of code_aster (manual U4.84.02), whose
    published tables they repeat. Where the solution itself is at hand, `contact_impacts` is
    exact.

    Parameters
    ----------
    times
        Instants in s, ascending, (n,).
    force
        Samples in N, (n,).
    closing_speed
        Speed towards the obstacle at the same instants in m/s, (n,); NaN where left out.
    threshold
        Force in N that an impact exceeds.
    rest
        Time in s between two impacts at least.

    Returns
    -------
    pandas.DataFrame
        The columns of `contact_impacts`.

    Raises
    ------
    InputError
        If the samples are not as many as the times, or these do not ascend.

    Examples
    --------
    >>> sampled_impacts([0, 1, 2, 3, 4, 5], [0, 2, 3, 0, 0, 1])[["start", "end", "impulse"]]
       start  end  impulse
    0    1.0  3.0      5.0
    1    5.0  NaN      0.5
    """
    instants, forces = samples("times", times), samples("force", force)
    speeds = np.full(instants.shape, np.nan)
    if closing_speed is not None:
        speeds = samples("closing_speed", closing_speed)
    columns = impact_samples(instants, forces, speeds, threshold=threshold, rest=rest)
    return labelled_columns(columns)


def samples_of(response: Response, law: int) -> dict[str, FloatArray]:
    """Return the impacts on a law, counted from 0, by samples at the times of a response."""
    _, rate, force = response.history.law_motion(law, response.times)
    return impact_samples(response.times, force, -rate)


def impact_samples(
    times: FloatArray,
    force: FloatArray,
    speed: FloatArray,
    *,
    threshold: float = 0.0,
    rest: float = 0.0,
) -> dict[str, FloatArray]:
    """Return the columns of `sampled_impacts` as plain arrays."""
    _check(times, force, speed)
    loaded = np.concatenate([[False], force > not_negative("threshold", threshold), [False]])
    change = np.flatnonzero(loaded[1:] != loaded[:-1])
    starts, stops = change[::2], change[1::2]
    ends = np.append(times, np.nan)[stops]
    pause = times[starts[1:]] - ends[:-1]
    first = np.flatnonzero(np.append(True, pause >= not_negative("rest", rest))[: len(starts)])
    last = np.append(first[1:], len(starts))[: len(first)] - 1
    width = _widths(times)
    parts = [slice(starts[a], stops[b]) for a, b in zip(first, last, strict=True)]
    peaks = np.array([part.start + int(np.argmax(force[part])) for part in parts], dtype=np.intp)
    loads = [np.where(force[part] > threshold, force[part] * width[part], 0.0) for part in parts]
    runs = np.append(times, times[-1])[stops] - times[starts]
    return {
        "start": times[starts[first]],
        "end": ends[last],
        "duration": ends[last] - times[starts[first]],
        "contact_time": np.add.reduceat(runs, first) if len(first) else np.empty(0),
        "rebounds": (last - first).astype(np.float64),
        "closing_speed": speed[starts[first]],
        "peak_time": times[peaks],
        "peak_force": force[peaks],
        "impulse": np.array([load.sum() for load in loads]),
    }


def _widths(times: FloatArray) -> FloatArray:
    """Return the time that each sample stands for: half way to its neighbours, (n,)."""
    steps = np.diff(times)
    widths: FloatArray = 0.5 * (np.append(steps, 0.0) + np.append(0.0, steps))
    return widths


def _check(times: FloatArray, force: FloatArray, speed: FloatArray) -> None:
    if times.ndim != 1 or len(times) < 2 or not np.all(np.diff(times) > 0.0):
        raise InputError("must be two or more instants in ascending order", key="times")
    if not np.isfinite(times).all():
        raise InputError("must be finite", key="times")
    # Speeds may be unknown, forces not: a gap in them would be taken as no contact.
    if not np.isfinite(force).all():
        raise InputError("must be finite", key="force")
    for key, values in (("force", force), ("closing_speed", speed)):
        if values.shape != times.shape:
            what = f"must be as many as there are times, {len(times)}"
            raise InputError(what, key=key, value=f"{values.size} values")
