"""The path of a node within, or beside, an obstacle about an axis."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.post.at_obstacle import places_at_obstacle
from bumpstop.report.curves import MOST_POINTS, instants, thin
from bumpstop.report.palette import LIGHT
from bumpstop.report.plotting import Axis, layout_of, line_trace
from bumpstop.report.scales import scale_for

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.laws.around_axis import StopAroundAxis
    from bumpstop.response import Response

__all__ = ["along_axis", "orbit"]

MOST_ARROWS = 12
"""Contacts whose force is drawn as an arrow: the hardest ones."""

_NAMES = ("x", "y", "z")


def orbit(response: Response, stop: StopAroundAxis) -> dict[str, Any]:
    """Draw the path of a stop's node in the plane of its obstacle, and what it may reach.

    Where the node is is told from the obstacle's centre, along the two directions of the plane.
    """
    times = instants(response)
    places = places_at_obstacle(response, stop, times)
    outline = stop.outline()
    kept = np.union1d(*(thin(each, at_most=MOST_POINTS // 2) for each in places.T))
    scale = scale_for("m", np.concatenate([places, outline]))
    x, y = (Axis(along_axis(direction), scale) for direction in stop.axes[:2])
    clock = scale_for("s", times)
    path = _path(places[kept], (x, y), "Path", "computed")
    path["customdata"] = times[kept] * clock.factor
    path["hovertemplate"] = (
        f"%{{x:.5~g}} {scale.unit}, %{{y:.5~g}} {scale.unit}"
        f"<br>at %{{customdata:.5~g}} {clock.unit}"
    )
    forces = response.history.law_forces(response.law_index(stop.name), times)[:, :2]
    pushes = np.hypot(*forces.T)
    force = scale_for("N", pushes)
    touching = kept[pushes[kept] > 0.0]
    contact = path | {
        "name": "In contact",
        "mode": "markers",
        "x": x.scaled(places[touching, 0]),
        "y": y.scaled(places[touching, 1]),
        "marker": {
            "size": 5,
            "color": pushes[touching] * force.factor,
            "colorscale": [[0.0, LIGHT["stored"]], [1.0, LIGHT["contact"]]],
            "cmin": 0.0,
            "colorbar": {"title": {"text": f"Force ({force.unit})"}, "thickness": 12},
        },
        "customdata": np.stack([times[touching] * clock.factor, pushes[touching]], axis=1)
        * [1.0, force.factor],
        "hovertemplate": f"%{{customdata[1]:.4~g}} {force.unit}"
        f"<br>at %{{customdata[0]:.5~g}} {clock.unit}",
    }
    border = _path(outline, (x, y), "Reached at", "contact")
    border["line"] |= {"dash": "dash", "width": 1.5}
    layout = layout_of(
        f"Path within {stop.name}", x, y, "Dashed: where the obstacle begins to push"
    )
    layout["hovermode"] = "closest"
    # Round is to look round.
    layout["yaxis"] |= {"scaleanchor": "x", "scaleratio": 1}
    layout["annotations"] = _arrows(response, stop.name, times, places, forces, scale.factor)
    return {"data": [path, *([contact] if len(touching) else []), border], "layout": layout}


def _arrows(
    response: Response,
    stop: str,
    times: FloatArray,
    places: FloatArray,
    forces: FloatArray,
    factor: float,
) -> list[dict[str, Any]]:
    """Return an arrow along the force on the node at the peak of each of the hardest contacts."""
    table = response.impact_table()
    own = [number for number, name in enumerate(table["stop"]) if name == stop]
    peaks = sorted(own, key=lambda number: -float(table["peak_force"][number]))[:MOST_ARROWS]
    arrows = []
    for number in peaks:
        at = int(np.searchsorted(times, float(table["peak_time"][number])).clip(max=len(times) - 1))
        push = forces[at]
        length = float(np.hypot(*push))
        largest = float(table["peak_force"][peaks[0]])
        if length <= 0.0 or not np.isfinite(largest):
            continue
        # From the node along the push, longer the harder it is.
        right, up = push / length * (14.0 + 40.0 * min(length / largest, 1.0))
        arrows.append(
            {
                "x": float(places[at, 0] * factor),
                "y": float(places[at, 1] * factor),
                "ax": -float(right),
                "ay": float(up),
                "text": "",
                "showarrow": True,
                "arrowhead": 2,
                "arrowwidth": 1.6,
                "arrowcolor": LIGHT["contact"],
            }
        )
    return arrows


def _path(places: FloatArray, axes: tuple[Axis, Axis], name: str, role: str) -> dict[str, Any]:
    x, y = axes
    return line_trace(x.scaled(places[:, 0]), y.scaled(places[:, 1]), name, role, y)


def along_axis(direction: FloatArray) -> str:
    """Return the name of a direction: that of a global axis where it is one."""
    axis = int(np.argmax(np.abs(direction)))
    if direction[axis] > 1.0 - 1e-9:
        return f"Along {_NAMES[axis]}"
    told = ", ".join(f"{part:.3g}" for part in direction + 0.0)
    return f"Along ({told})"
