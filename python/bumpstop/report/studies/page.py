"""What stands on the page of a study."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop import __version__
from bumpstop.report.palette import DARK, LIGHT
from bumpstop.report.scales import scale_for, significant
from bumpstop.report.studies.axes import parameters_of, run_numbers
from bumpstop.report.studies.bars import shares_figure, sobol_figure, tornado_figure
from bumpstop.report.studies.grids import basin_figure, curve_figure, heat_figure
from bumpstop.report.studies.points import (
    histogram_figure,
    over_time_figure,
    scatter_figure,
    two_ways_figure,
)
from bumpstop.report.studies.searched import search_figure
from bumpstop.report.variant import caption, untitled
from bumpstop.report.words import shown
from bumpstop.study.basins import SECTION
from bumpstop.study.sampling import DRAWN

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from bumpstop.report.figures import Figure
    from bumpstop.study.study import Study

__all__ = ["study_content"]

MOST_TOLD = 20_000
"""Runs whose values the page tells on a click; of others it knows the number and the command."""
MOST_PARAMETERS = 6
LEAST_FOR_SHARES = 50
"""Of fewer runs, chance would be most of what their variance tells."""
MOST_FAILURES = 20


def study_content(
    study: Study, results: xr.Dataset, opened_by: str
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return what the template fills in, and the data that the page's scripts read.

    Parameters
    ----------
    study, results, opened_by
        As `bumpstop.report.write_study` takes them.
    """
    outputs = [name for name in study.outputs if name not in SECTION]
    figures = {
        f"figure-{number}": figure
        for number, figure in enumerate(_figures(study, results, outputs), start=1)
    }
    numbers = run_numbers(results).values.ravel()
    failed = np.flatnonzero(results.failed.values.ravel())
    content = {
        "description": "",
        "case_name": "study",
        "version": __version__,
        "verdict": _verdict(study.runs.count, len(failed)),
        "facts": _facts(study, len(failed)),
        "parameters": _parameters(study),
        "outputs": [_statistics(results[name], numbers) for name in outputs],
        "weighting": _weighting(study.sampling.method),
        "attractors": _attractors(results) if study.basins else [],
        "count": study.runs.count,
        "figures": [caption(name, figure) for name, figure in figures.items()],
        "failures": [
            {"run": int(numbers[at]), "message": str(results.message.values.flat[at])}
            for at in failed[:MOST_FAILURES]
        ],
        "more_failures": max(0, len(failed) - MOST_FAILURES),
    }
    data = {
        "themes": {"light": LIGHT, "dark": DARK},
        "figures": {name: untitled(figure) for name, figure in figures.items()},
        "motions": {},
        "modes": {},
        "runs": _runs(study, results, outputs, opened_by),
    }
    return content, data


def _figures(study: Study, results: xr.Dataset, outputs: Sequence[str]) -> Iterator[Figure]:
    if study.basins is not None and _is_map(results):
        yield basin_figure(results)
    for name in outputs:
        if not np.isfinite(results[name].values).any():
            continue
        if study.follows:
            yield two_ways_figure(results, name)
        elif study.outputs[name].shape:
            yield from _over_times(results, name)
        elif study.sampling.method == "one_at_a_time":
            yield tornado_figure(results, name)
        elif study.searches:
            yield from _of_search(study, results, name)
        else:
            yield from _of_numbers(results, name)


def _over_times(results: xr.Dataset, name: str) -> Iterator[Figure]:
    parameters = parameters_of(results)
    if len(parameters) == 1 and results[parameters[0]].dtype.kind in "iuf":
        yield over_time_figure(results, name)


def _of_numbers(results: xr.Dataset, name: str) -> Iterator[Figure]:
    parameters = parameters_of(results)
    if _is_map(results):
        yield heat_figure(results, name)
    elif results.failed.dims != ("run",):
        yield curve_figure(results, name)
    else:
        yield histogram_figure(results, name)
        for parameter in parameters[:MOST_PARAMETERS]:
            yield scatter_figure(results, name, parameter)
    if f"{name}_total" in results:
        yield sobol_figure(results, name)
    elif len(parameters) > 1 and results.failed.size >= LEAST_FOR_SHARES:
        yield shares_figure(results, name)


def _of_search(study: Study, results: xr.Dataset, name: str) -> Iterator[Figure]:
    if name == study.sought:
        yield search_figure(results, name)
    for parameter in parameters_of(results)[:MOST_PARAMETERS]:
        yield scatter_figure(results, name, parameter)


def _is_map(results: xr.Dataset) -> bool:
    return len(results.failed.dims) > 1


def _verdict(runs: int, failed: int) -> dict[str, str]:
    if not failed:
        return {"state": "passed", "text": f"all {runs:,} runs were made"}
    return {"state": "failed", "text": f"{failed:,} of {runs:,} runs failed"}


def _facts(study: Study, failed: int) -> list[dict[str, str]]:
    sampling = study.sampling.method.replace("_", " ")
    seeded = study.searches or study.sampling.method in DRAWN
    seed = f"seed {study.sampling.seed}" if seeded else ""
    return [
        {"name": "Runs", "value": f"{study.runs.count:,}", "note": ""},
        {"name": "Failed", "value": f"{failed:,}", "note": ""},
        {"name": "Sampling", "value": sampling, "note": seed},
        {"name": "Variant", "value": str(study.variant), "note": ""},
    ]


def _parameters(study: Study) -> list[dict[str, str]]:
    rows = []
    for name in study.parameters:
        levels = study.runs.levels[name]
        if any(isinstance(level, str) for level in levels[:1]):
            told = ", ".join(map(str, dict.fromkeys(levels)))
        else:
            low, high = (significant(float(end(levels)), 6, zeros=False) for end in (min, max))
            unit = f" {shown(study.units[name])}" if name in study.units else ""
            many = f" to {high}{unit}, {len(set(levels)):,} values"
            told = low + (unit if low == high else many)
        rows.append({"name": name, "levels": told})
    return rows


def _weighting(method: str) -> str:
    if method in DRAWN:
        return "samples are drawn as the parameters scatter, so that these are tolerance statistics"
    if method == "worst_case":
        return "a search crowds where the sought output is large, so that only extremes tell much"
    return "each run counts alike, however likely its values are"


def _statistics(array: xr.DataArray, numbers: NDArray[np.int64]) -> dict[str, Any]:
    """Return a row of the table of results; ``numbers`` are those of the runs."""
    values = np.asarray(array.values, dtype=float)
    own: dict[str, Any] = {"name": str(array.name)}
    flat = values.reshape(len(numbers), -1)
    known = flat[np.isfinite(flat)]
    unit = shown(str(array.attrs.get("units", "1")))
    scale = scale_for(unit, known) if unit != "1" else None
    factor = scale.factor if scale else 1.0
    own |= {"unit": scale.unit if scale else "", "known": len(known) > 0}
    if not len(known):
        return own
    low, median, high = np.quantile(known, (0.05, 0.5, 0.95))
    told = {
        "smallest": known.min(),
        "low": low,
        "median": median,
        "mean": known.mean(),
        "deviation": known.std(ddof=1) if len(known) > 1 else 0.0,
        "high": high,
        "largest": known.max(),
    }
    runs = {
        "smallest_run": int(numbers[np.nanargmin(flat) // flat.shape[1]]),
        "largest_run": int(numbers[np.nanargmax(flat) // flat.shape[1]]),
    }
    return own | runs | {key: significant(value * factor, 5) for key, value in told.items()}


def _attractors(results: xr.Dataset) -> list[list[str]]:
    rows = zip(
        results.attractor_runs.values,
        results.attractor_periods.values,
        results.attractor_displacement.values,
        results.attractor_velocity.values,
        strict=True,
    )
    return [
        [f"{runs:,}", str(period), significant(float(x[0]), 6), significant(float(v[0]), 6)]
        for runs, period, x, v in rows
    ]


def _runs(
    study: Study, results: xr.Dataset, outputs: Sequence[str], opened_by: str
) -> dict[str, Any]:
    """Return what a click tells of runs: parameters and numbers, with all bits that it can."""
    count = study.runs.count
    told = np.arange(count)[:: -(-count // MOST_TOLD)]
    order = np.argsort(run_numbers(results).values.ravel(), kind="stable")
    rows = [study.runs.row(int(run)) for run in told]
    values: dict[str, Any] = {
        name: _column([row[name] for row in rows]) for name in study.parameters
    }
    for name in outputs:
        if not study.outputs[name].shape:
            values[name] = results[name].values.ravel()[order][told]
    of_outputs = {name: str(results[name].attrs.get("units", "1")) for name in outputs}
    units = {name: shown(unit) for name, unit in (study.units | of_outputs).items() if unit != "1"}
    return {
        "count": count,
        "command": opened_by,
        "numbers": told,
        "values": values,
        "units": units,
    }


def _column(levels: Sequence[Any]) -> NDArray[np.float64] | list[str]:
    if any(isinstance(level, str | bool) for level in levels):
        return [str(level) for level in levels]
    return np.array(levels, dtype=float)
