"""Figures of many points: bifurcation diagrams, and outputs over drawn samples."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, cast

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
    units_of,
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
    "two_ways_figure",
]

MOST_MARKS = 5000
"""Points that are drawn one by one; more become a picture of how many lie in each pixel."""
SMALL = (200, 320)
"""Rows and columns of a picture of which a page has many."""
QUANTILES = (0.05, 0.5, 0.95)
SHADES = (
    (LIGHT["kinetic"], LIGHT["computed"], "#001a33"),
    (LIGHT["stored"], LIGHT["contact"], "#331500"),
)
"""Colours of few points, more and many in a pixel; of each cloud. Marks have the second."""


class Cloud(NamedTuple):
    """Points that belong together."""

    x: FloatArray
    y: FloatArray
    name: str = ""
    runs: NDArray[np.int64] | None = None
    """Numbers of the runs that they are of."""


def bifurcation_diagram(points: pd.DataFrame | xr.Dataset, output: str = "value") -> go.Figure:
    """Draw the points of many motions over a parameter, with plotly.

    Ten million points take about a second: they are counted in pixels, and the picture has their
    logarithm.

    Parameters
    ----------
    points
        As `bifurcation` gives them; as `follow` does, whose ways up and down get colours of
        their own, over the first of the parameters; or the results of a study of one parameter
        with an output at many times, such as once a period.
    output
        The column of the values; the name of the output of a study.

    Raises
    ------
    InputError
        If there is no such column or output, or more than one parameter.
    """
    if hasattr(points, "data_vars"):
        results = cast("xr.Dataset", points)
        draw = two_ways_figure if "way" in results.dims else over_time_figure
        return as_plotly(draw(results, output))
    if not hasattr(points, "columns"):
        hint = "take what bs.bifurcation, bs.follow or a study returns"
        raise InputError("must be a table or a Dataset", key="points", value=points, hint=hint)
    if output not in points.columns:
        raise InputError("no such column", key="output", value=output)
    name = str(points.columns[0])
    units = points.attrs.get("units", {}).get(name, "1")
    x, y = (np.asarray(points[column], dtype=float) for column in (name, output))
    return as_plotly(
        bifurcation_figure((name, units), [Cloud(x, y)], Axis(output, Scale(1.0, "1")))
    )


def bifurcation_figure(parameter: tuple[str, str], clouds: Sequence[Cloud], axis: Axis) -> Figure:
    """Draw points over a parameter, each cloud in colours of its own."""
    name, units = parameter
    across = Axis(name, Scale(1.0, units))
    count = sum(len(cloud.x) for cloud in clouds)
    draw = _marks if count <= MOST_MARKS else _picture
    hover = f"{name} = %{{x:.5~g}}<br>%{{y:.5~g}} {axis.scale.unit}"
    traces = []
    for cloud, shades in zip(clouds, SHADES, strict=False):
        trace = draw(cloud._replace(y=axis.scaled(cloud.y)), shades)
        told = hover if cloud.runs is None else f"{hover}<br>run %{{customdata}}"
        trace |= {"hovertemplate": f"{told}<extra>{cloud.name}</extra>", "name": cloud.name}
        traces.append(trace | {"showlegend": len(clouds) > 1})
    there = sum(int(np.isfinite(cloud.y).sum()) for cloud in clouds)
    layout = layout_of(f"{axis.name} over {name}", across, axis, f"{there:,} points")
    layout |= {"hovermode": "closest", "showlegend": len(clouds) > 1}
    return {"data": traces, "layout": layout}


def over_time_figure(results: xr.Dataset, output: str) -> Figure:
    """Draw an output at many times over the only parameter of a study."""
    array = required(results, output)
    names = parameters_of(results)
    if array.ndim != 2 or len(names) != 1 or array[names[0]].dtype.kind not in "iuf":
        what = "must be numbers at several times over one parameter"
        raise InputError(what, key="output", value=output)
    runs = run_numbers(results).values
    cloud = _cloud(array[names[0]], array)._replace(runs=np.repeat(runs, array.shape[1]))
    return bifurcation_figure((names[0], units_of(array[names[0]])), [cloud], output_axis(array))


def two_ways_figure(results: xr.Dataset, output: str) -> Figure:
    """Draw an output of runs that follow one another up and down a parameter."""
    array = required(results, output)
    if array.dtype.kind not in "iuf":
        raise InputError("must be numbers", key="output", value=output)
    name, levels = next(
        (key, each) for key, each in results.coords.items() if each.dims == ("run",)
    )
    clouds = [_cloud(levels, ways)._replace(name=str(ways.way.values)) for ways in array]
    if "run_number" in results.coords:
        numbers = results.coords["run_number"].values
        each = array[0].size // levels.size
        clouds = [
            cloud._replace(runs=np.repeat(runs, each))
            for cloud, runs in zip(clouds, numbers, strict=True)
        ]
    return bifurcation_figure((str(name), units_of(levels)), clouds, output_axis(array))


def _cloud(levels: xr.DataArray, values: xr.DataArray) -> Cloud:
    """Return all numbers of each run over its level."""
    each = values.size // levels.size
    return Cloud(np.repeat(np.asarray(levels.values, dtype=float), each), values.values.ravel())


def scatter_figure(results: xr.Dataset, output: str, parameter: str) -> Figure:
    """Draw an output over the drawn values of a parameter."""
    array = required(results, output)
    axis = output_axis(array)
    levels = results[parameter].values
    numbers = levels.dtype.kind in "iuf"
    hover = f"{parameter} = %{{x:.5~g}}<br>%{{y:.5~g}} {axis.scale.unit}<br>run %{{customdata}}"
    if numbers and len(levels) > MOST_MARKS:
        runs = run_numbers(results).values
        cloud = Cloud(levels.astype(float), axis.scaled(array.values), runs=runs)
        trace = _picture(cloud, SHADES[0], SMALL)
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
    return {"data": [trace], "layout": layout_over(title, results[parameter], axis.layout())}


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


def _marks(cloud: Cloud, shades: Sequence[str]) -> dict[str, Any]:
    """Return points one by one."""
    trace = {
        "type": "scatter",
        "mode": "markers",
        "x": cloud.x,
        "y": cloud.y,
        "marker": {"size": 3, "color": shades[1]},
    }
    return trace if cloud.runs is None else trace | {"customdata": cloud.runs}


def _picture(
    cloud: Cloud, shades: Sequence[str], size: tuple[int, int] = (ROWS, COLUMNS)
) -> dict[str, Any]:
    """Return points as a map of the logarithm of how many lie in each pixel."""
    raster = rastered(cloud.x, cloud.y, *size)
    with np.errstate(divide="ignore"):
        shade = np.where(raster.counts > 0, np.log10(raster.counts), np.nan)
    trace: dict[str, Any] = {
        "type": "heatmap",
        "x": raster.x,
        "y": raster.y,
        "z": shade,
        "colorscale": [[0.5 * place, colour] for place, colour in enumerate(shades)],
        "showscale": False,
        "hoverongaps": False,
    }
    if cloud.runs is not None:
        trace["customdata"] = np.where(raster.some >= 0, cloud.runs[raster.some], -1)
    return trace


def _upright(x: float) -> dict[str, Any]:
    line = {"color": LIGHT["contact"], "width": 1.2, "dash": "dot"}
    ends = {"x0": x, "x1": x, "y0": 0, "y1": 1}
    return {"type": "line", "xref": "x", "yref": "paper", **ends, "line": line}
