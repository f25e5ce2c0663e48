"""Figures of which parameter matters: Sobol's indices and tornado charts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.arguments import did_you_mean
from bumpstop.errors import InputError
from bumpstop.report.figures import Figure, as_plotly
from bumpstop.report.palette import LIGHT
from bumpstop.report.plotting import Axis, layout_of
from bumpstop.report.scales import Scale
from bumpstop.report.studies.axes import (
    check_results,
    output_axis,
    parameters_of,
    required,
    run_numbers,
)

if TYPE_CHECKING:
    import plotly.graph_objects as go
    import xarray as xr

    from bumpstop.arguments import FloatArray

__all__ = ["shares_figure", "sobol_chart", "sobol_figure", "tornado_chart", "tornado_figure"]

_NONE = Axis("", Scale(1.0, "1"))


def sobol_chart(indices: xr.Dataset, output: str) -> go.Figure:
    """Draw which part of a result's variance comes from which parameter, with plotly.

    Parameters
    ----------
    indices
        As `sobol_indices` gives them.
    output
        Name of the result.

    Raises
    ------
    InputError
        If there are no indices of such a result.
    """
    check_results("indices", indices)
    return as_plotly(sobol_figure(indices, output))


def tornado_chart(swings: xr.Dataset, output: str) -> go.Figure:
    """Draw how far each parameter moves a result, the one that matters most on top, with plotly.

    Parameters
    ----------
    swings
        As `one_at_a_time` gives them.
    output
        Name of the result.

    Raises
    ------
    InputError
        If there is no such result.
    """
    check_results("swings", swings)
    return as_plotly(tornado_figure(swings, output))


def sobol_figure(indices: xr.Dataset, output: str) -> Figure:
    """Return the figure that `sobol_chart` draws, as a plain dict."""
    known = [str(name).removesuffix("_total") for name in indices if str(name).endswith("_total")]
    if output not in known:
        hint = did_you_mean(output, known)
        raise InputError("no such result", key="output", value=output, hint=hint)
    first, total = indices[f"{output}_first"], indices[f"{output}_total"]
    order = np.argsort(total.values, kind="stable")
    names = [str(total.parameter.values[at]) for at in order]
    bars = [
        _bars(names, first.values[order], None, "alone", "computed"),
        # Estimates of indices near zero may be a bit below it.
        _bars(names, total.values[order], None, "alone and with others", "kinetic"),
    ]
    for bar in bars:
        bar["hovertemplate"] = "%{y}: %{x:.3f}<extra></extra>"
    layout = layout_of(f"What the variance of {output} comes from", _NONE, _NONE)
    return _sideways(bars, layout, Axis("Part of the variance", Scale(1.0, "1")), "group")


def tornado_figure(swings: xr.Dataset, output: str) -> Figure:
    """Return the figure that `tornado_chart` draws, as a plain dict."""
    beside = ("failed", "message", "value")
    known = [str(name) for name in swings.data_vars if name not in beside]
    if output not in known:
        hint = did_you_mean(output, known)
        raise InputError("no such result", key="output", value=output, hint=hint)
    if "side" not in swings.dims:
        what = "must be of a study of one parameter at a time"
        raise InputError(what, key="swings", hint="take what bs.one_at_a_time returns")
    array = swings[output]
    axis = output_axis(array)
    low, middle, high = (axis.scaled(array.sel(side=side).values) for side in swings.side.values)
    reach = np.nanmax(np.abs(np.stack([low, high]) - middle), axis=0, initial=0.0)
    order = np.argsort(reach, kind="stable")
    names = [str(swings.parameter.values[at]) for at in order]
    values, runs = swings["value"].values, run_numbers(swings).values
    bars = []
    for name, ends, column, role in (("low", low, 0, "kinetic"), ("high", high, 2, "contact")):
        bar = _bars(names, (ends - middle)[order], middle[order], name, role)
        bar["customdata"] = runs[order, column]
        bar["hovertext"] = [
            f"{_short(values[at, column])}<br>{ends[at]:.5g} {axis.scale.unit}" for at in order
        ]
        bar["hovertemplate"] = "%{y} = %{hovertext}<br>run %{customdata}<extra></extra>"
        bars.append(bar)
    words = "One parameter low or high, the others in their middle"
    layout = layout_of(f"What moves {output}", _NONE, _NONE, words)
    return _sideways(bars, layout, axis, "overlay")


def shares_figure(results: xr.Dataset, output: str) -> Figure:
    """Draw which part of the variance each parameter makes alone, from the runs that are there.

    The correlation ratio: the variance of means over runs with like values of a parameter, over
    the variance of all (K. Pearson, *Proceedings of the Royal Society* 71, 1903), less what
    chance alone would make of it (T. L. Kelley, *PNAS* 21, 1935). It estimates Sobol's
    first-order index, less sharply than `sobol_indices` does with runs of its own.
    """
    array = required(results, output)
    names = parameters_of(results)
    shares = np.array([_share(array, results[name]) for name in names])
    order = np.argsort(shares, kind="stable")
    bar = _bars([names[at] for at in order], shares[order], None, "alone", "computed")
    bar["hovertemplate"] = "%{y}: %{x:.3f}<extra></extra>"
    words = "Estimated from these runs; the rest comes from parameters together"
    layout = layout_of(f"What the variance of {output} comes from", _NONE, _NONE, words)
    layout["showlegend"] = False
    return _sideways([bar], layout, Axis("Part of the variance", Scale(1.0, "1")), "group")


def _share(array: xr.DataArray, parameter: xr.DataArray) -> float:
    """Return the part of the variance between classes of a parameter."""
    values = np.asarray(array.values, dtype=float).ravel()
    levels = parameter.broadcast_like(array).transpose(*array.dims).values.ravel()
    known = np.isfinite(values)
    values = values[known]
    classes = np.unique(levels[known], return_inverse=True)[1]
    number = int(classes.max(initial=0)) + 1
    if number > CLASSES:  # drawn: as many in each class
        ranks = np.argsort(np.argsort(levels[known], kind="stable"), kind="stable")
        number = CLASSES
        classes = ranks * number // len(ranks)
    total = float(((values - values.mean()) ** 2).sum()) if len(values) else 0.0
    if total == 0.0 or len(values) <= number:
        return 0.0
    counts = np.bincount(classes, minlength=number)
    means = np.bincount(classes, values - values.mean(), number) / np.maximum(counts, 1)
    between = float((counts * means**2).sum())
    by_chance = (number - 1) / (len(values) - number) * (total - between)
    # On a grid nothing is by chance; what is left there comes from the other parameters.
    drawn = array.dims == ("run",)
    return max(0.0, (between - by_chance * drawn) / total)


CLASSES = 12
"""Classes of equally many runs that drawn values are put in."""


def _bars(
    names: list[str], lengths: FloatArray, base: FloatArray | None, name: str, role: str
) -> dict[str, Any]:
    bars = {
        "type": "bar",
        "orientation": "h",
        "name": name,
        "x": lengths,
        "y": names,
        "marker": {"color": LIGHT[role]},
    }
    return bars if base is None else bars | {"base": base}


def _sideways(bars: list[dict[str, Any]], layout: dict[str, Any], axis: Axis, mode: str) -> Figure:
    category = _NONE.layout() | {"type": "category"}
    layout |= {"xaxis": axis.layout(), "yaxis": category, "barmode": mode, "hovermode": "closest"}
    # At the right: the subtitle stands at the left.
    layout["legend"] |= {"traceorder": "normal", "x": 1, "xanchor": "right"}
    return {"data": bars, "layout": layout}


def _short(value: Any) -> Any:
    return f"{value:.6g}" if isinstance(value, float) else value
