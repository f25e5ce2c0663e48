"""Figures of many points: bifurcation diagrams, and outputs over drawn samples."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

import numpy as np

from bumpstop.errors import InputError
from bumpstop.report.figures import Figure, as_plotly
from bumpstop.report.palette import LIGHT
from bumpstop.report.plotting import Axis, layout_of
from bumpstop.report.scales import Scale
from bumpstop.report.studies.axes import (
    layout_over,
    output_axis,
    parameters_of,
    required,
    run_numbers,
)
from bumpstop.report.studies.raster import COLUMNS, ROWS, rastered

if TYPE_CHECKING:
    import pandas as pd
    import plotly.graph_objects as go
    import xarray as xr
    from numpy.typing import NDArray

    from bumpstop.arguments import FloatArray

__all__ = [
    "bifurcation_diagram",
    "bifurcation_figure",
    "histogram_figure",
    "over_time_figure",
    "scatter_figure",
]

MOST_MARKS = 5000
"""Points that are drawn one by one; more become a picture of how many lie in each pixel."""
SMALL = (200, 320)
"""Rows and columns of a picture of which a page has many."""
QUANTILES = (0.05, 0.5, 0.95)


def bifurcation_diagram(points: pd.DataFrame | xr.Dataset, output: str = "value") -> go.Figure:
    """Draw the points of many motions over a parameter, with plotly.

    Ten million points take about a second: they are counted in pixels, and the picture has their
    logarithm.

    Parameters
    ----------
    points
        As `bifurcation` gives them, or the results of a study of one parameter with an output
        at many times, such as once a period.
    output
        The column of the values; the name of the output of a study.

    Raises
    ------
    InputError
        If there is no such column or output, or more than one parameter.
    """
    if hasattr(points, "data_vars"):
        return as_plotly(over_time_figure(cast("xr.Dataset", points), output))
    if output not in points.columns:
        raise InputError("no such column", key="output", value=output)
    name = str(points.columns[0])
    units = points.attrs.get("units", {}).get(name, "1")
    x, y = (np.asarray(points[column], dtype=float) for column in (name, output))
    return as_plotly(bifurcation_figure((name, units), x, y, Axis(output, Scale(1.0, "1"))))


def bifurcation_figure(
    parameter: tuple[str, str],
    x: FloatArray,
    y: FloatArray,
    axis: Axis,
    runs: NDArray[np.int64] | None = None,
) -> Figure:
    """Draw points over a parameter; ``runs`` are the numbers of the runs that they are of."""
    name, units = parameter
    across = Axis(name, Scale(1.0, units))
    hover = f"{name} = %{{x:.5~g}}<br>%{{y:.5~g}} {axis.scale.unit}"
    if runs is not None:
        hover += "<br>run %{customdata}"
    trace: dict[str, Any]
    if len(x) <= MOST_MARKS:
        trace = {"type": "scatter", "mode": "markers", "x": x, "y": axis.scaled(y)}
        trace |= {"marker": {"size": 3, "color": LIGHT["computed"]}}
        if runs is not None:
            trace["customdata"] = runs
    else:
        trace = _picture(x, axis.scaled(y), runs)
    trace["hovertemplate"] = f"{hover}<extra></extra>"
    layout = layout_of(f"{axis.name} over {name}", across, axis, f"{len(x):,} points")
    layout |= {"hovermode": "closest", "showlegend": False}
    return {"data": [trace], "layout": layout}


def over_time_figure(results: xr.Dataset, output: str) -> Figure:
    """Draw an output at many times over the only parameter of a study."""
    array = required(results, output)
    names = parameters_of(results)
    if array.ndim != 2 or len(names) != 1 or array[names[0]].dtype.kind not in "iuf":
        what = "must be numbers at several times over one parameter"
        raise InputError(what, key="output", value=output)
    times = array.shape[1]
    levels = np.asarray(array[names[0]].values, dtype=float)
    runs = np.repeat(run_numbers(results).values, times)
    axis = output_axis(array)
    values = array.values.ravel()
    return bifurcation_figure((names[0], "1"), np.repeat(levels, times), values, axis, runs)


def scatter_figure(results: xr.Dataset, output: str, parameter: str) -> Figure:
    """Draw an output over the drawn values of a parameter."""
    array = required(results, output)
    axis = output_axis(array)
    levels = results[parameter].values
    numbers = levels.dtype.kind in "iuf"
    hover = f"{parameter} = %{{x:.5~g}}<br>%{{y:.5~g}} {axis.scale.unit}<br>run %{{customdata}}"
    if numbers and len(levels) > MOST_MARKS:
        runs = run_numbers(results).values
        trace = _picture(levels.astype(float), axis.scaled(array.values), runs, SMALL)
    else:
        chosen = slice(None, None, -(-len(levels) // MOST_MARKS))
        trace = {
            "type": "scatter",
            "mode": "markers",
            "x": levels[chosen] if numbers else [str(level) for level in levels[chosen]],
            "y": axis.scaled(array.values)[chosen],
            "customdata": run_numbers(results).values[chosen],
            "marker": {"size": 4, "color": LIGHT["computed"], "opacity": 0.7},
        }
    trace["hovertemplate"] = f"{hover}<extra></extra>"
    title = f"{axis.name} over {parameter}"
    return {"data": [trace], "layout": layout_over(title, (parameter, levels), axis.layout())}


def histogram_figure(results: xr.Dataset, output: str) -> Figure:
    """Draw how often an output has which value, with three quantiles."""
    array = required(results, output)
    axis = output_axis(array)
    values = axis.scaled(array.values)
    values = values[np.isfinite(values)]
    # Numpy's rule may ask for far too many where a few values lie far out.
    edges = np.histogram_bin_edges(values, bins=min(60, max(10, int(np.sqrt(len(values))))))
    counts, _ = np.histogram(values, edges)
    unit = "" if axis.scale.unit == "1" else f" {axis.scale.unit}"
    trace = {
        "type": "bar",
        "x": (edges[:-1] + edges[1:]) / 2.0,
        "y": counts,
        "width": np.diff(edges),
        "marker": {"color": LIGHT["computed"]},
        "hovertemplate": f"%{{y}} runs about %{{x:.5~g}}{unit}<extra></extra>",
    }
    at = np.quantile(values, QUANTILES) if len(values) else np.empty(0)
    words = ", ".join(
        f"{share:.0%}: {value:.4g}{unit}" for share, value in zip(QUANTILES, at, strict=False)
    )
    title = f"{axis.name}: {len(values):,} runs"
    layout = layout_of(title, axis, Axis("Runs", Scale(1.0, "1")), f"Below which lie {words}")
    layout |= {"hovermode": "closest", "showlegend": False, "bargap": 0.0}
    layout["shapes"] = [_upright(float(value)) for value in at]
    return {"data": [trace], "layout": layout}


def _picture(
    x: FloatArray,
    y: FloatArray,
    runs: NDArray[np.int64] | None,
    size: tuple[int, int] = (ROWS, COLUMNS),
) -> dict[str, Any]:
    """Return points as a map of the logarithm of how many lie in each pixel."""
    raster = rastered(x, y, *size)
    with np.errstate(divide="ignore"):
        shade = np.where(raster.counts > 0, np.log10(raster.counts), np.nan)
    trace: dict[str, Any] = {
        "type": "heatmap",
        "x": raster.x,
        "y": raster.y,
        "z": shade,
        "colorscale": [[0.0, LIGHT["kinetic"]], [0.5, LIGHT["computed"]], [1.0, "#001a33"]],
        "showscale": False,
        "hoverongaps": False,
    }
    if runs is not None:
        trace["customdata"] = np.where(raster.some >= 0, runs[raster.some], -1)
    return trace


def _upright(x: float) -> dict[str, Any]:
    line = {"color": LIGHT["contact"], "width": 1.2, "dash": "dot"}
    ends = {"x0": x, "x1": x, "y0": 0, "y1": 1}
    return {"type": "line", "xref": "x", "yref": "paper", **ends, "line": line}
