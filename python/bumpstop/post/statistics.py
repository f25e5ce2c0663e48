"""Contact statistics of a stop: over the run, block by block, and in classes."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray, count, finite, not_negative, one_of
from bumpstop.errors import InputError
from bumpstop.post.contacts import (
    counted_impacts,
    integrals_between,
    labelled_columns,
    loaded_spans,
)
from bumpstop.post.impacts import impacts_of
from bumpstop.post.of_run import of_run
from bumpstop.post.peaks import largest_forces
from bumpstop.post.spans import Spans, cut_spans, spans_within
from bumpstop.quantities import COUNTED_IMPACTS, MOST_BLOCKS, MOST_CLASSES, STATISTICS

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from bumpstop.response import Response

__all__ = ["ContactStatistics", "contact_statistics"]

TOTALS = ("impact_count", "contact_time")
"""Statistics of the run that are the sums of its blocks'; the others are means, or largest."""
SAME = 1e-12
"""Values that differ by less, relative to their size, fall into one class."""


@dataclass(frozen=True, eq=False)
class ContactStatistics:
    """What `contact_statistics` found.

    Attributes
    ----------
    stop
        The stop.
    columns
        The impacts that begin in the time looked at, plain columns; `impacts` labels them.
    values
        Each statistic of `bumpstop.quantities.STATISTICS`, SI units; NaN where there is none,
        as of a mean over no impact.
    uncertainty
        Standard error of each, from the scatter of the blocks: of a mean, a rate or a fraction
        s / sqrt(blocks), of a sum over the time looked at s sqrt(blocks). A largest value has none.
    edges
        Ends of the blocks in s, (blocks + 1,).
    blocks
        Each statistic in each block, (blocks,).
    classes
        Number of classes of the histograms.
    """

    stop: str
    columns: dict[str, FloatArray] = field(repr=False)
    values: dict[str, float] = field(repr=False)
    uncertainty: dict[str, float] = field(repr=False)
    edges: FloatArray = field(repr=False)
    blocks: dict[str, FloatArray] = field(repr=False)
    classes: int

    def __getitem__(self, statistic: str) -> float:
        """Return a statistic by its name, in SI units."""
        return self.values[one_of("statistic", statistic, tuple(STATISTICS))]

    def _repr_html_(self) -> str:
        told: str = self.table.to_html()
        return told

    @cached_property
    def impacts(self) -> pd.DataFrame:
        """The impacts that were counted, as `contact_impacts` has them."""
        return labelled_columns(self.columns)

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row a statistic: its value, standard error, unit and meaning."""
        import pandas as pd

        rows = {
            "value": self.values,
            "standard_error": self.uncertainty,
            "units": {name: what.units for name, what in STATISTICS.items()},
            "meaning": {name: what.long_name for name, what in STATISTICS.items()},
        }
        return pd.DataFrame(rows, index=pd.Index(STATISTICS, name="statistic"))

    @cached_property
    def by_block(self) -> xr.Dataset:
        """Each statistic over ``block``, the middle of each block in s.

        A run is stationary where they scatter about a level and show no trend.
        """
        import xarray as xr

        return xr.Dataset(
            {
                name: ("block", self.blocks[name], STATISTICS[name].attributes)
                for name in STATISTICS
            },
            coords={
                "block": ("block", 0.5 * (self.edges[1:] + self.edges[:-1]), {"units": "s"}),
                "start": ("block", self.edges[:-1], {"units": "s"}),
                "end": ("block", self.edges[1:], {"units": "s"}),
            },
            attrs={"stop": self.stop},
        )

    def histogram(self, column: str = "peak_force") -> xr.DataArray:
        """Return how many impacts fall in each class of a column of `impacts`.

        Classes are equally wide, from the smallest value to the largest; values on a bound
        count above it, the largest in the last class. Values that are the same but for rounding
        are in one class, as wide as nothing. Impacts without a finite value of it, such as the
        forces of blows on rigid stops, are in none, and the title says how many they are.

        Raises
        ------
        InputError
            If there is no such column, or no impact has a finite value of it.
        """
        import xarray as xr

        what = COUNTED_IMPACTS[one_of("column", column, tuple(COUNTED_IMPACTS))]
        values = self.columns[column]
        finite_ones = values[np.isfinite(values)]
        if not len(finite_ones):
            raise InputError("no impact has a finite value of it", key="column", value=column)
        counts, edges = _histogram(finite_ones, self.classes)
        coordinates = {
            column: (column, 0.5 * (edges[1:] + edges[:-1]), what.attributes),
            "from": (column, edges[:-1], {"units": what.units}),
            "to": (column, edges[1:], {"units": what.units}),
        }
        title = f"Impacts on {self.stop} by {what.long_name}"
        if len(finite_ones) < len(values):
            title += f", without {len(values) - len(finite_ones)} that have no finite one"
        attributes = STATISTICS["impact_count"].attributes | {"stop": self.stop}
        return xr.DataArray(
            counts,
            coords=coordinates,
            dims=column,
            name="impacts",
            attrs=attributes | {"drawn": "bars", "title": title},
        )


@of_run
def contact_statistics(
    response: Response,
    stop: str,
    *,
    threshold: float = 0.0,
    rest: float = 0.0,
    start: float = 0.0,
    end: float | None = None,
    blocks: int = 10,
    classes: int = 10,
) -> ContactStatistics:
    """Return the statistics of the impacts on a stop.

    Mean and rms forces are integrals of the solution itself over the time in which the force
    exceeds the threshold, not sums over samples; the largest force is that within this time.
    Means over impacts are over those that begin in the time looked at, of durations over those
    that also end in the run.

    Parameters
    ----------
    response
        The run.
    stop
        Name of the stop.
    threshold, rest
        What counts as one impact, in N and s; see `contact_impacts`.
    start, end
        The time looked at, in s; all of the run where left out.
    blocks
        Number of equal blocks that this time is cut into. Their scatter gives the standard
        errors, s / sqrt(blocks) with the standard deviation s of the blocks' values (batch
        means: A. M. Law, Simulation Modeling and Analysis, section 9.5.3), which holds if
        blocks are much longer than the memory of the motion. A number of impacts and a time
        loaded are sums of the blocks, with s sqrt(blocks); largest values grow with the time
        looked at, and the scatter of blocks tells no error of them: NaN.
    classes
        Number of classes of histograms.

    Raises
    ------
    InputError
        If there is no such stop, or a number cannot be used.

    Examples
    --------
    >>> import bumpstop as bs
    >>> basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    >>> wall = bs.RigidStop("wall", node="P", normal=(1, 0, 0), gap=0.0, restitution=1.0)
    >>> thrown = bs.ModalState(velocity=[0.5])
    >>> run = bs.simulate(bs.Problem(basis, laws=[wall], initial=thrown, duration=10.2))
    >>> found = bs.contact_statistics(run, "wall")
    >>> found["impact_count"], round(found["mean_impulse"], 12)
    (20.0, 1.0)
    """
    law = response.stop_index(stop)
    edges = _edges(response, start, end, count("blocks", blocks, most=MOST_BLOCKS))
    count("classes", classes, most=MOST_CLASSES)
    columns = counted_impacts(response, stop, threshold=threshold, rest=rest)
    inside = (columns["start"] >= edges[0]) & (columns["start"] < edges[-1])
    columns = {name: column[inside] for name, column in columns.items()}
    spans = spans_within(loaded_spans(response, stop, threshold), edges[0], edges[-1])
    pieces, _ = cut_spans(spans, edges)
    works = _block_integrals(response, law, pieces, edges)
    peaks = _block_peaks(response, law, pieces, edges)
    owner = _blocks(columns["start"], edges)
    one_by_one = [
        _statistics(
            {name: column[owner == number] for name, column in columns.items()},
            works[number],
            float(peaks[number]),
            float(edges[number + 1] - edges[number]),
        )
        for number in range(blocks)
    ]
    by_block = {name: np.array([part[name] for part in one_by_one]) for name in STATISTICS}
    values = _statistics(
        columns, works.sum(axis=0), float(np.fmax.reduce(peaks)), float(edges[-1] - edges[0])
    )
    return ContactStatistics(
        stop=stop,
        columns=columns,
        values=values,
        # Of what is not known of the whole, its blocks tell no error.
        uncertainty={
            name: math.nan if math.isnan(values[name]) else _standard_error(name, each)
            for name, each in by_block.items()
        },
        edges=edges,
        blocks=by_block,
        classes=classes,
    )


def _edges(response: Response, start: float, end: float | None, blocks: int) -> FloatArray:
    duration = response.problem.duration
    first = not_negative("start", start)
    last = duration if end is None else finite("end", end)
    if not first < last <= duration:
        what = f"must lie after the start, {first:g} s, and within the run of {duration:g} s"
        raise InputError(what, key="end", value=last)
    return np.linspace(first, last, blocks + 1)


def _block_integrals(response: Response, law: int, pieces: Spans, edges: FloatArray) -> FloatArray:
    """Return time loaded, integral of the force and of its square in each block, (blocks, 3)."""
    loads = np.column_stack([pieces.ends - pieces.starts, integrals_between(response, law, pieces)])
    total = np.zeros((len(edges) - 1, 3))
    np.add.at(total, _blocks(pieces.starts, edges), loads)
    _add_blows(total, impacts_of(response, law), edges)
    return total


def _block_peaks(response: Response, law: int, pieces: Spans, edges: FloatArray) -> FloatArray:
    """Return the largest force in each block, (blocks,), NaN where there is none."""
    contacts = impacts_of(response, law)
    owner = np.searchsorted(contacts["start"], pieces.starts, side="right") - 1
    when = contacts["peak_time"][owner]
    # The core knows the peak of a whole contact; those of other parts are to be found.
    largest = contacts["peak_force"][owner]
    other = ~((pieces.starts <= when) & (when <= pieces.ends))
    rest = Spans(pieces.starts[other], pieces.ends[other])
    largest[other] = largest_forces(response, law, rest)[0]
    blows = contacts["start"][contacts["duration"] == 0.0]
    blows = blows[(blows >= edges[0]) & (blows < edges[-1])]
    peaks = np.full(len(edges) - 1, np.nan)
    np.fmax.at(peaks, _blocks(pieces.starts, edges), largest)
    np.fmax.at(peaks, _blocks(blows, edges), np.inf)
    return peaks


def _blocks(times: FloatArray, edges: FloatArray) -> NDArray[np.intp]:
    """Return the block that each instant is in."""
    return np.searchsorted(edges, times, side="right") - 1


def _add_blows(total: FloatArray, contacts: dict[str, FloatArray], edges: FloatArray) -> None:
    """Add impulses without duration, as rigid stops give them; no rms force is finite then."""
    blows = (contacts["duration"] == 0.0) & (contacts["start"] >= edges[0])
    blows &= contacts["start"] < edges[-1]
    block = _blocks(contacts["start"][blows], edges)
    np.add.at(total[:, 1], block, contacts["impulse"][blows])
    total[block, 2] = np.nan


def _statistics(
    columns: dict[str, FloatArray], work: FloatArray, largest: float, time: float
) -> dict[str, float]:
    loaded, impulse, square = (float(value) for value in work)
    number = len(columns["start"])
    durations = columns["duration"][~np.isnan(columns["duration"])]
    speeds, peaks, impulses = (columns[key] for key in ("closing_speed", "peak_force", "impulse"))
    rigid = bool(np.isinf(peaks).any())
    return {
        "impact_count": float(number),
        "impact_rate": number / time,
        "mean_interval": _mean(np.diff(columns["start"])),
        "contact_time": loaded,
        "contact_fraction": loaded / time,
        "mean_duration": _mean(durations),
        "largest_duration": _largest(durations),
        "mean_closing_speed": _mean(speeds),
        "rms_closing_speed": math.sqrt(_mean(speeds**2)),
        "largest_closing_speed": _largest(speeds),
        "mean_peak_force": _mean(peaks),
        "deviation_peak_force": _deviation(peaks),
        "largest_force": largest,
        "mean_impulse": _mean(impulses),
        "largest_impulse": _largest(impulses),
        "mean_force": impulse / time,
        "rms_force": math.sqrt(square / time),
        "mean_force_in_contact": impulse / loaded if loaded and not rigid else math.nan,
        "rms_force_in_contact": math.sqrt(square / loaded) if loaded else math.nan,
    }


def _histogram(values: FloatArray, classes: int) -> tuple[NDArray[np.intp], FloatArray]:
    """Return numbers of values in classes (classes,) and the bounds of these (classes + 1,)."""
    low, high = float(values.min()), float(values.max())
    if high - low <= SAME * max(abs(low), abs(high)):
        return np.array([len(values)]), np.array([low, high])
    return np.histogram(values, bins=classes)


def _mean(values: FloatArray) -> float:
    return float(np.mean(values)) if len(values) else math.nan


def _deviation(values: FloatArray) -> float:
    known = len(values) > 1 and bool(np.isfinite(values).all())
    return float(np.std(values, ddof=1)) if known else math.nan


def _largest(values: FloatArray) -> float:
    return float(np.max(values)) if len(values) else math.nan


def _standard_error(name: str, blocks: FloatArray) -> float:
    """Return the standard error of a statistic by its blocks, of those that have a value."""
    if name.startswith("largest_"):
        return math.nan
    known = blocks[np.isfinite(blocks)]
    error = _deviation(known) / math.sqrt(max(len(known), 1))
    return error * len(blocks) if name in TOTALS else error
