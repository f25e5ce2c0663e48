"""Figures in which the curves of several runs lie over each other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.report.curves import MOST_POINTS, instants, thin
from bumpstop.report.palette import LIGHT
from bumpstop.report.plotting import Axis, layout_of, line_trace
from bumpstop.report.scales import scale_for
from bumpstop.report.words import title_of, unit_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from bumpstop.arguments import FloatArray
    from bumpstop.report.figures import Figure
    from bumpstop.response import Response

__all__ = ["energy_overlay", "quantity_overlay"]

ROLES = ("computed", "contact", "stops", "stored", "damping", "kinetic")
"""Colours of the first runs; the next ones have them again, dashed otherwise."""
DASHES = ("solid", "dash", "dot", "dashdot", "longdash")

ENERGIES = {
    "Energy of the motion": ("kinetic", "elastic", "stored"),
    "Energy lost": ("dissipated_damping", "dissipated_stops"),
}
"""Titles of the figures of energy, and the terms of the ledger that each adds up."""


def quantity_overlay(responses: Mapping[str, Response], target: tuple[str, ...]) -> Figure:
    """Draw a quantity of several runs over time.

    Parameters
    ----------
    responses
        The runs by name; all know the target.
    target
        The quantity and what it is that of, as `bumpstop.Response.sample` takes them.
    """

    def values(response: Response, times: FloatArray) -> FloatArray:
        return response.sample(*target, times=times)

    unit = unit_of(target[0], target[2] if len(target) > 2 else None)
    name = target[0].replace("_", " ").capitalize()
    return _overlay(responses, values, title_of(target), name, unit)


def energy_overlay(responses: Mapping[str, Response], title: str) -> Figure:
    """Draw a sum of energies of several runs over time, one of `ENERGIES`."""
    terms = ENERGIES[title]

    def values(response: Response, times: FloatArray) -> FloatArray:
        ledger = response.energy_terms(times)
        return np.asarray(np.sum([ledger[term] for term in terms], axis=0), dtype=np.float64)

    return _overlay(responses, values, title, "Energy", "J")


def _overlay(
    responses: Mapping[str, Response],
    read: Callable[[Response, FloatArray], FloatArray],
    title: str,
    name: str,
    unit: str,
) -> Figure:
    curves = {run: _curve(response, read) for run, response in responses.items()}
    longest = max(response.problem.duration for response in responses.values())
    time = Axis("Time", scale_for("s", longest))
    across = Axis(name, scale_for(unit, np.concatenate([values for _, values in curves.values()])))
    data = []
    for number, (run, (times, values)) in enumerate(curves.items()):
        role = ROLES[number % len(ROLES)]
        trace = line_trace(time.scaled(times), across.scaled(values), run, role, across)
        trace["line"]["dash"] = DASHES[number % len(DASHES)]
        trace["hovertemplate"] += f"<br>at %{{x:.5~g}} {time.scale.unit}"
        data.append(trace)
    layout: dict[str, Any] = layout_of(title, time, across)
    layout["hovermode"] = "closest"
    layout["xaxis"] |= {"range": [0.0, longest * time.scale.factor]}
    layout["showlegend"] = True
    layout["legend"]["font"] = {"color": LIGHT["ink"]}
    return {"data": data, "layout": layout}


def _curve(
    response: Response, read: Callable[[Response, FloatArray], FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Return the points of a curve that are worth drawing."""
    times = instants(response)
    values = read(response, times)
    kept = thin(values, at_most=MOST_POINTS)
    return times[kept], values[kept]
