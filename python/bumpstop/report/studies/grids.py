"""Figures of a study on a grid: curves, heat maps, basins of attraction.

As in `bumpstop.report.figures`, functions are pure and return plotly's JSON as plain dicts. Behind
every point stands the number of its run, in ``customdata``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.errors import InputError
from bumpstop.report.figures import Figure, as_plotly
from bumpstop.report.palette import LIGHT
from bumpstop.report.studies.axes import (
    check_results,
    layout_over,
    output_axis,
    parameter_axis,
    parameters_of,
    required,
    run_numbers,
)

if TYPE_CHECKING:
    import plotly.graph_objects as go
    import xarray as xr
    from numpy.typing import NDArray

__all__ = ["basin_figure", "basin_map", "curve_figure", "heat_figure", "heat_map"]

MOST_LEVELS = 500
"""Values of a parameter that a map shows; of more, every second, third, ... is drawn."""

NO_ATTRACTOR = LIGHT["grid"]
ATTRACTORS = tuple(
    LIGHT[role] for role in ("computed", "stored", "stops", "contact", "damping", "kinetic")
)
"""Colours of the attractors, in the order of how many runs end on them; then again."""


def heat_map(
    results: xr.Dataset, output: str, x: str | None = None, y: str | None = None
) -> go.Figure:
    """Draw an output of a study over two of its parameters, with plotly.

    Parameters
    ----------
    results
        Of a study on a grid, as `Study.run` and `open_study` give them.
    output
        Name of an output that is a single number.
    x, y
        Parameters on the axes; the two of most values where left out. Over further ones the
        largest value is shown.

    Raises
    ------
    InputError
        If there is no such output or parameter, or the study is none on a grid of two.
    """
    check_results("results", results)
    return as_plotly(heat_figure(results, output, x, y))


def basin_map(results: xr.Dataset, x: str | None = None, y: str | None = None) -> go.Figure:
    """Draw which attractor the runs of a study end on, with plotly.

    Parameters
    ----------
    results
        Of a study on a grid with `Basins`.
    x, y
        Parameters on the axes; the two of most values where left out. Of further ones the
        first value is shown.

    Raises
    ------
    InputError
        If the study looked for no attractors, or is none on a grid of two parameters.
    """
    check_results("results", results)
    return as_plotly(basin_figure(results, x, y))


def curve_figure(results: xr.Dataset, output: str) -> Figure:
    """Draw an output over the only parameter of a grid."""
    array = required(results, output)
    (name,) = parameters_of(results)
    axis = output_axis(array)
    levels = array[name].values
    trace = {
        "type": "scatter",
        "mode": "lines+markers",
        "x": _written(levels),
        "y": axis.scaled(array.values),
        "customdata": run_numbers(results).values,
        "line": {"color": LIGHT["computed"], "width": 1.6},
        "marker": {"size": 5},
        "hovertemplate": f"%{{y:.5~g}} {axis.scale.unit}<br>{name} = %{{x:.5~g}}"
        "<br>run %{customdata}<extra></extra>",
    }
    title = str(array.attrs.get("long_name", output))
    return {
        "data": [trace],
        "layout": layout_over(_capital(title), array[name], axis.layout()),
    }


def heat_figure(
    results: xr.Dataset, output: str, x: str | None = None, y: str | None = None
) -> Figure:
    """Return the figure that `heat_map` draws, as a plain dict."""
    array = required(results, output)
    across, up = _two_of(results, array, x, y)
    others = [str(name) for name in array.dims if name not in (across, up)]
    values, runs = _largest_over(array, run_numbers(results), across, up)
    told = f"largest over {', '.join(others)}" if others else ""
    axis = output_axis(array)
    columns, rows = (_shown(array[name].values) for name in (across, up))
    trace = {
        "type": "heatmap",
        "x": _written(array[across].values[columns]),
        "y": _written(array[up].values[rows]),
        "z": axis.scaled(values[np.ix_(rows, columns)]),
        "customdata": runs[np.ix_(rows, columns)],
        "colorscale": "Viridis",
        "colorbar": {"title": {"text": axis.scale.unit if axis.scale.unit != "1" else ""}},
        "hovertemplate": f"%{{z:.5~g}} {axis.scale.unit}<br>{across} = %{{x:.5~g}}"
        f"<br>{up} = %{{y:.5~g}}<br>run %{{customdata}}<extra></extra>",
    }
    title = _capital(str(array.attrs.get("long_name", output)))
    y_axis = parameter_axis(array[up])
    return {
        "data": [trace],
        "layout": layout_over(title, array[across], y_axis, _capital(told)),
    }


def basin_figure(results: xr.Dataset, x: str | None = None, y: str | None = None) -> Figure:
    """Return the figure that `basin_map` draws, as a plain dict."""
    if "attractor" not in results:
        hint = "give the study basins"
        raise InputError("the study looked for no attractors", key="results", hint=hint)
    across, up = _two_of(results, results.attractor, x, y)
    first = {name: 0 for name in results.attractor.dims if name not in (across, up)}
    seen = results.attractor.isel(first).transpose(up, across)
    runs = run_numbers(results).isel(first).transpose(up, across).values
    columns, rows = (_shown(seen[name].values) for name in (across, up))
    periods = results.attractor_periods.values
    scale, ticks = _attractor_colours(len(periods))
    words = ["none found", *(f"{n} (period {p})" for n, p in enumerate(periods, start=1))]
    trace = {
        "type": "heatmap",
        "x": _written(seen[across].values[columns]),
        "y": _written(seen[up].values[rows]),
        "z": seen.values[np.ix_(rows, columns)],
        "customdata": runs[np.ix_(rows, columns)],
        "zmin": -0.5,
        "zmax": len(periods) + 0.5,
        "colorscale": scale,
        "colorbar": {"tickvals": ticks, "ticktext": [words[tick] for tick in ticks]},
        "hovertemplate": f"attractor %{{z}}<br>{across} = %{{x:.5~g}}<br>{up} = %{{y:.5~g}}"
        "<br>run %{customdata}<extra></extra>",
    }
    y_axis = parameter_axis(seen[up])
    layout = layout_over("Basins of attraction", seen[across], y_axis)
    return {"data": [trace], "layout": layout}


def _two_of(
    results: xr.Dataset, array: xr.DataArray, x: str | None, y: str | None
) -> tuple[str, str]:
    """Return the parameters on the axes."""
    names = [str(name) for name in array.dims]
    if names == ["run"] or set(names) != set(parameters_of(results)) or len(names) < 2:
        what = "must be single numbers over a grid of two parameters or more"
        raise InputError(what, key="output", value=str(array.name))
    for key, given in (("x", x), ("y", y)):
        if given is not None and given not in names:
            hint = f"known: {', '.join(names)}"
            raise InputError("no such parameter", key=key, value=given, hint=hint)
    sizes = array.sizes
    by_size = sorted(names, key=lambda name: (-sizes[name], names.index(name)))
    left = [name for name in by_size if name not in (x, y)]
    across = x or left.pop(0)
    up = y or left.pop(0)
    if across == up:
        raise InputError("is on the other axis, too", key="y", value=y)
    return across, up


def _largest_over(
    array: xr.DataArray, runs: xr.DataArray, across: str, up: str
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the largest values over all other parameters, (up, across), and their runs."""
    ordered = array.transpose(up, across, ...)
    flat = ordered.values.reshape(*ordered.shape[:2], -1)
    numbers = runs.transpose(*ordered.dims).values.reshape(flat.shape)
    best = np.where(np.isnan(flat), -np.inf, flat).argmax(axis=-1)[..., np.newaxis]
    values = np.take_along_axis(flat, best, axis=-1)[..., 0]
    return values, np.take_along_axis(numbers, best, axis=-1)[..., 0]


def _written(levels: NDArray[Any]) -> NDArray[Any] | list[str]:
    """Return values of a parameter as plotly takes them: words where they are no numbers."""
    return levels if levels.dtype.kind in "iuf" else [str(level) for level in levels]


def _shown(levels: NDArray[Any]) -> NDArray[np.int64]:
    """Return which values of a parameter a map shows."""
    return np.arange(0, len(levels), -(-len(levels) // MOST_LEVELS))


def _attractor_colours(number: int) -> tuple[list[list[Any]], list[int]]:
    """Return a colour scale of steps, one an attractor, and which of them are named."""
    colours = [NO_ATTRACTOR, *(ATTRACTORS[n % len(ATTRACTORS)] for n in range(number))]
    steps = np.linspace(0.0, 1.0, number + 2).tolist()
    pairs = zip(steps[:-1], steps[1:], colours, strict=True)
    scale = [[place, colour] for low, high, colour in pairs for place in (low, high)]
    return scale, list(range(0, number + 1, max(1, number // 12)))


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
