"""The path of a node within, or beside, an obstacle about an axis."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.report.curves import MOST_POINTS, instants, thin
from bumpstop.report.plotting import Axis, layout_of, line_trace
from bumpstop.report.scales import scale_for

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.laws.around_axis import StopAroundAxis
    from bumpstop.response import Response

__all__ = ["orbit"]

_NAMES = ("x", "y", "z")


def orbit(response: Response, stop: StopAroundAxis) -> dict[str, Any]:
    """Draw the path of a stop's node in the plane of its obstacle, and what it may reach.

    Where the node is is told from the obstacle's centre, along the two directions of the plane.
    """
    times = instants(response)
    places = stop.places(response.problem.basis, response.motion(0, times))
    outline = stop.outline()
    kept = np.union1d(*(thin(each, at_most=MOST_POINTS // 2) for each in places.T))
    scale = scale_for("m", np.concatenate([places, outline]))
    x, y = (Axis(_along(direction), scale) for direction in stop.axes[:2])
    clock = scale_for("s", times)
    path = _path(places[kept], (x, y), "Path", "computed")
    path["customdata"] = times[kept] * clock.factor
    path["hovertemplate"] = (
        f"%{{x:.5~g}} {scale.unit}, %{{y:.5~g}} {scale.unit}"
        f"<br>at %{{customdata:.5~g}} {clock.unit}"
    )
    border = _path(outline, (x, y), "Reached at", "contact")
    border["line"] |= {"dash": "dash", "width": 1.5}
    layout = layout_of(
        f"Path within {stop.name}", x, y, "Dashed: where the obstacle begins to push"
    )
    layout["hovermode"] = "closest"
    # Round is to look round.
    layout["yaxis"] |= {"scaleanchor": "x", "scaleratio": 1}
    return {"data": [path, border], "layout": layout}


def _path(places: FloatArray, axes: tuple[Axis, Axis], name: str, role: str) -> dict[str, Any]:
    x, y = axes
    return line_trace(x.scaled(places[:, 0]), y.scaled(places[:, 1]), name, role, y)


def _along(direction: FloatArray) -> str:
    """Return the name of a direction: that of a global axis where it is one."""
    axis = int(np.argmax(np.abs(direction)))
    if direction[axis] > 1.0 - 1e-9:
        return f"Along {_NAMES[axis]}"
    told = ", ".join(f"{part:.3g}" for part in direction + 0.0)
    return f"Along ({told})"
