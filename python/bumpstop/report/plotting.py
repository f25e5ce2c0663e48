"""What all figures share: axes with units, lines, shaded contacts, fonts and margins."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.report.curves import contact_spans
from bumpstop.report.palette import LIGHT

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bumpstop.arguments import FloatArray
    from bumpstop.report.scales import Scale
    from bumpstop.response import Response

__all__ = [
    "MOST_BANDS",
    "Axis",
    "bands",
    "boundary",
    "contact_bands",
    "layout_of",
    "line_trace",
    "whole_run",
]

FONT = 'Inter, "Segoe UI", Roboto, "Helvetica Neue", "Liberation Sans", Arial, sans-serif'

MOST_BANDS = 60
"""More shaded contacts than this would only make the paper grey."""


class Axis:
    """A quantity on an axis: what it is and how it is scaled."""

    def __init__(self, name: str, scale: Scale) -> None:
        self.name = name
        self.scale = scale

    def scaled(self, values: FloatArray) -> FloatArray:
        """Return SI values in the unit of the axis."""
        return np.asarray(values, dtype=float) * self.scale.factor

    def layout(self) -> dict[str, Any]:
        """Return the axis as plotly has it."""
        unit = "" if self.scale.unit == "1" else f" ({self.scale.unit})"
        return {
            "title": {
                "text": f"{escape(self.name, quote=False)}{unit}",
                "standoff": 8,
                "font": {"size": 12.5},
            },
            "automargin": True,
            "showline": True,
            "ticks": "outside",
            "ticklen": 4,
            "gridcolor": LIGHT["grid"],
            "linecolor": LIGHT["axis"],
            "tickcolor": LIGHT["axis"],
            "zerolinecolor": LIGHT["axis"],
            "zerolinewidth": 1,
        }


def layout_of(title: str, x: Axis, y: Axis, subtitle: str = "") -> dict[str, Any]:
    """Return the layout of a figure: its heading, axes, fonts and colours."""
    heading: dict[str, Any] = {"text": escape(title, quote=False), "x": 0.0, "xref": "paper"}
    if subtitle:
        heading["subtitle"] = {"text": subtitle, "font": {"color": LIGHT["muted"]}}
    return {
        "title": heading,
        "font": {"family": FONT, "size": 13, "color": LIGHT["ink"]},
        "paper_bgcolor": LIGHT["paper"],
        "plot_bgcolor": LIGHT["paper"],
        "margin": {"l": 60, "r": 14, "t": 64, "b": 48},
        "hovermode": "x unified",
        "hoverlabel": {
            "bgcolor": LIGHT["paper"],
            "bordercolor": LIGHT["axis"],
            "font": {"color": LIGHT["ink"], "family": FONT},
        },
        "legend": {"orientation": "h", "x": 0, "y": 1.01, "yanchor": "bottom"},
        "xaxis": x.layout(),
        "yaxis": y.layout(),
    }


def whole_run(response: Response, clock: Axis) -> dict[str, Any]:
    """Return what a time axis has beside its name: the whole run, and times with their unit."""
    return {
        "range": [0.0, response.problem.duration * clock.scale.factor],
        "unifiedhovertitle": {"text": f"%{{x:.5~g}} {clock.scale.unit}"},
    }


def line_trace(x: FloatArray, y: FloatArray, name: str, role: str, axis: Axis) -> dict[str, Any]:
    """Return a curve in the colour of a role; ``axis`` is the one that y is read on."""
    return {
        "type": "scatter",
        "mode": "lines",
        "name": name,
        "x": x,
        "y": y,
        "line": {"color": LIGHT[role], "width": 1.8, "simplify": False},
        "hovertemplate": f"%{{y:.5~g}} {axis.scale.unit}",
    }


def contact_bands(response: Response, clock: Scale) -> list[dict[str, Any]]:
    """Return the shading of the stretches of time in which a stop is closed."""
    return bands(contact_spans(response), clock)


def bands(spans: Sequence[tuple[float, float]], clock: Scale) -> list[dict[str, Any]]:
    """Return the shading of stretches of time, unless there are too many."""
    if len(spans) > MOST_BANDS:
        return []
    return [
        {
            "type": "rect",
            "layer": "below",
            "xref": "x",
            "yref": "paper",
            "x0": start * clock.factor,
            "x1": end * clock.factor,
            "y0": 0,
            "y1": 1,
            "fillcolor": LIGHT["contact"],
            "opacity": 0.07,
            "line": {"width": 0},
        }
        for start, end in spans
    ]


def boundary(x: float) -> dict[str, Any]:
    """Return a dashed upright line at which contact begins."""
    return {
        "type": "line",
        "layer": "below",
        "xref": "x",
        "yref": "paper",
        "x0": x,
        "x1": x,
        "y0": 0,
        "y1": 1,
        "line": {"color": LIGHT["contact"], "width": 1.5, "dash": "dash"},
    }
