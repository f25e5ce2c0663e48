"""Figures of labelled arrays: whatever was read out of a run, by the units that it carries."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.arguments import one_of
from bumpstop.errors import InputError
from bumpstop.report.curves import thin
from bumpstop.report.figures import Figure, as_plotly
from bumpstop.report.palette import LIGHT
from bumpstop.report.plotting import Axis, layout_of, line_trace
from bumpstop.report.scales import Scale, scale_for
from bumpstop.report.words import shown

if TYPE_CHECKING:
    import plotly.graph_objects as go
    import xarray as xr

__all__ = ["array_figure", "plot"]

THIN = 1e-2
"""Least width of a bar, relative to where it stands."""
KINDS = ("line", "bars", "points", "map")
LOGARITHMIC = ("", "x", "y", "z", "xy", "xz", "yz", "xyz")
MOST_CELLS = 250_000
"""Cells of a map: more only make the page heavy."""


def plot(array: xr.DataArray, kind: str | None = None, *, log: str = "") -> go.Figure:
    """Draw a labelled array, such as a spectrum, a histogram or a history, with plotly.

    Parameters
    ----------
    array
        Of one dimension, or of two for a map; units and names are taken from its attributes.
    kind
        ``"line"``, ``"bars"``, ``"points"`` or ``"map"``; by its attribute ``drawn`` and its
        shape where left out.
    log
        Axes that are logarithmic: ``"x"``, ``"y"``, ``"xy"``; of a map, ``"z"`` is its colour.

    Raises
    ------
    InputError
        If an array of its shape cannot be drawn so.

    Examples
    --------
    >>> import xarray as xr
    >>> rise = xr.DataArray([0.0, 2e-3], coords={"time": [0.0, 0.1]}, name="displacement")
    >>> plot(rise.assign_attrs(units="m")).layout.yaxis.title.text
    'Displacement (mm)'
    """
    return as_plotly(array_figure(array, kind, log=log))


def array_figure(array: xr.DataArray, kind: str | None = None, *, log: str = "") -> Figure:
    """Return the figure that `plot` draws, as a plain dict."""
    if not hasattr(array, "dims") or not hasattr(array, "attrs"):
        what = "must be a labelled array, as responses and results give them"
        raise InputError(what, key="array", value=type(array).__name__)
    if not isinstance(log, str) or log not in LOGARITHMIC:
        hint = f"known: {', '.join(LOGARITHMIC[1:])}"
        raise InputError("unknown axes", key="log", value=log, hint=hint)
    if kind is not None:
        one_of("kind", kind, KINDS)
    kind = kind or str(array.attrs.get("drawn", "line" if array.ndim == 1 else "map"))
    if kind not in KINDS or array.ndim != (2 if kind == "map" else 1):
        what = f"an array of {array.ndim} dimensions cannot be drawn so"
        raise InputError(what, key="kind", value=kind, hint=f"known: {', '.join(KINDS)}")
    if kind == "map":
        return _map(array, log)
    x = _axis(array[str(array.dims[0])], "x" in log)
    y = _axis(array, "y" in log)
    figure = {"bars": _bars, "points": _points, "line": _line}[kind](array, x, y)
    layout = layout_of(_title(array), x, y)
    layout["hovermode"] = "closest"
    layout["showlegend"] = False
    for key in ("x", "y"):
        if key in log:
            layout[f"{key}axis"]["type"] = "log"
    return {"data": [figure], "layout": layout}


def _line(array: xr.DataArray, x: Axis, y: Axis) -> dict[str, Any]:
    values = np.asarray(array.values, dtype=float)
    kept = thin(values)
    places = np.asarray(array[str(array.dims[0])].values, dtype=float)[kept]
    trace = line_trace(x.scaled(places), y.scaled(values[kept]), "Computed", "computed", y)
    trace["hovertemplate"] += f"<br>at %{{x:.5~g}} {x.scale.unit}<extra></extra>"
    return trace


def _points(array: xr.DataArray, x: Axis, y: Axis) -> dict[str, Any]:
    trace = _line(array, x, y) | {"mode": "markers", "marker": {"size": 6}}
    places = np.asarray(array[str(array.dims[0])].values, dtype=float)
    trace |= {"x": x.scaled(places), "y": y.scaled(array.values)}
    trace["marker"]["color"] = LIGHT["computed"]
    trace["cliponaxis"] = False
    return trace


def _bars(array: xr.DataArray, x: Axis, y: Axis) -> dict[str, Any]:
    name = str(array.dims[0])
    places = np.asarray(array[name].values, dtype=float)
    bars: dict[str, Any] = {
        "type": "bar",
        "x": x.scaled(places),
        "y": y.scaled(array.values),
        "marker": {"color": LIGHT["computed"]},
        "hovertemplate": f"%{{y:.5~g}} {y.scale.unit}<br>at %{{x:.4~g}} {x.scale.unit}"
        "<extra></extra>",
    }
    if "from" in array.coords and "to" in array.coords:
        width = array["to"].values - array["from"].values
        # A class of values that are all the same has no width of its own.
        bars["width"] = x.scaled(np.maximum(width, THIN * np.abs(places)))
    return bars


def _map(array: xr.DataArray, log: str) -> Figure:
    down, across = (array[str(name)] for name in array.dims)
    step = int(np.ceil(np.sqrt(max(array.size / MOST_CELLS, 1.0))))
    thinned = array[::step, ::step]
    x, y = _axis(across, "x" in log), _axis(down, "y" in log)
    z = _axis(array, "z" in log)
    colours = np.asarray(thinned.values, dtype=float)
    name = f"{z.name.lower()} ({z.scale.unit})"
    if "z" in log:
        colours = np.log10(np.maximum(colours, np.finfo(float).tiny))
        colours = np.maximum(colours, colours.max() - 8.0)
        name = f"log₁₀ of {name}"
    else:
        colours = z.scaled(colours)
    layout = layout_of(_title(array), x, y, name)
    layout["hovermode"] = "closest"
    trace = {
        "type": "heatmap",
        "x": x.scaled(across.values[::step]),
        "y": y.scaled(down.values[::step]),
        "z": colours,
        "colorscale": "Viridis",
        "hovertemplate": f"%{{z:.4~g}}<br>%{{x:.4~g}} {x.scale.unit}, %{{y:.4~g}} "
        f"{y.scale.unit}<extra></extra>",
    }
    return {"data": [trace], "layout": layout}


def _axis(array: xr.DataArray, log: bool) -> Axis:
    """Return the axis of an array; a logarithmic one keeps SI units, whatever its range."""
    words = str(array.name or array.attrs.get("long_name", "value")).replace("_", " ")
    words = words[:1].upper() + words[1:]
    unit = shown(str(array.attrs.get("units", "1")))
    known = np.asarray(array.values, dtype=float)
    known = known[np.isfinite(known)]
    # Prefixes are for plain units; "mm²/Hz" would be read as something else.
    plain = not log and unit.isalpha() and unit != "kg"
    return Axis(words, scale_for(unit, known) if plain and known.size else Scale(1.0, unit))


def _title(array: xr.DataArray) -> str:
    told = str(array.attrs.get("title", array.attrs.get("long_name", array.name)))
    return told[:1].upper() + told[1:]
