"""Figure of a search for the worst case: what each run gave, and the worst so far."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bumpstop.errors import InputError
from bumpstop.report.figures import Figure, as_plotly
from bumpstop.report.palette import LIGHT
from bumpstop.report.plotting import Axis, layout_of
from bumpstop.report.scales import Scale
from bumpstop.report.studies.axes import check_results, output_axis, required, run_numbers

if TYPE_CHECKING:
    import plotly.graph_objects as go
    import xarray as xr

__all__ = ["search_chart", "search_figure"]

MOST_MARKS = 5000


def search_chart(results: xr.Dataset, output: str) -> go.Figure:
    """Draw what each run of a search has given, and the largest value so far, with plotly.

    Parameters
    ----------
    results
        Those of a study whose sampling is ``"worst_case"``.
    output
        Name of the output.

    Raises
    ------
    InputError
        If there is no such output, or not one number for each run.
    """
    check_results("results", results)
    return as_plotly(search_figure(results, output))


def search_figure(results: xr.Dataset, output: str) -> Figure:
    """Return the figure that `search_chart` draws, as a plain dict."""
    array = required(results, output)
    if array.dims != ("run",) or array.dtype.kind not in "iuf":
        raise InputError("must be one number for each run", key="output", value=output)
    axis = output_axis(array)
    runs, values = run_numbers(results).values, axis.scaled(array.values)
    largest = np.maximum.accumulate(np.where(np.isnan(values), -np.inf, values))
    better = np.flatnonzero(largest > np.concatenate([[-np.inf], largest[:-1]]))
    unit = "" if axis.scale.unit == "1" else f" {axis.scale.unit}"
    hover = f"%{{y:.6~g}}{unit}<br>run %{{customdata}}<extra></extra>"
    chosen = slice(None, None, -(-len(runs) // MOST_MARKS) or 1)
    marks = {
        "type": "scatter",
        "mode": "markers",
        "name": "a run",
        "x": runs[chosen],
        "y": values[chosen],
        "customdata": runs[chosen],
        "marker": {"size": 4, "color": LIGHT["computed"], "opacity": 0.7},
        "hovertemplate": hover,
    }
    steps = {
        "type": "scatter",
        "mode": "lines+markers",
        "name": "largest so far",
        # Up to the last run, though it has nothing larger.
        "x": np.append(runs[better], runs[-1:] if len(better) else []),
        "y": np.append(largest[better], largest[better][-1:]),
        "customdata": np.append(runs[better], runs[better][-1:]),
        "line": {"color": LIGHT["contact"], "width": 1.5, "shape": "hv"},
        "marker": {"size": 5},
        "hovertemplate": hover,
    }
    words = f"Largest in run {runs[better[-1]]}" if len(better) else "No run has it"
    layout = layout_of(
        f"Search for the largest {output.replace('_', ' ')}",
        Axis("Run", Scale(1.0, "1")),
        axis,
        words,
    )
    layout |= {"hovermode": "closest"}
    return {"data": [marks, steps], "layout": layout}
