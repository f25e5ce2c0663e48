"""The structure in space with its stops, moving, as a plotly figure."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.report.law_scene import law_nodes
from bumpstop.report.outline import outline, view_of
from bumpstop.report.palette import LIGHT
from bumpstop.report.plotting import FONT
from bumpstop.report.scales import scale_for, significant
from bumpstop.report.scene import UPRIGHT, motion_scene
from bumpstop.report.space_parts import SpaceDrawing

if TYPE_CHECKING:
    from collections.abc import Sequence

    import plotly.graph_objects as go

    from bumpstop.arguments import FloatArray
    from bumpstop.report.figures import Figure
    from bumpstop.response import Response

__all__ = ["scene_figure", "space_layout", "still_at_first"]

MOST_FRAMES = 120
MOST_COORDINATES = 60_000
"""Points of all frames at one scale; it keeps the figure light."""
FRAME_MILLISECONDS = 60
EYE = 1.5
WIDEST = 3.4
TALLEST = 1.7
"""How far the camera is, and how large things may look, as plotly counts: they fill the frame."""
STRAIGHT = 0.99


def scene_figure(response: Response, magnification: float | None = None) -> Figure:
    """Return the figure that `bumpstop.draw_scene` draws, as a plain dict with its frames."""
    problem = response.problem
    drawing = outline(problem.basis, law_nodes(problem))
    frames = min(MOST_FRAMES, max(MOST_COORDINATES // (3 * len(drawing.positions)), 24))
    scene = motion_scene(response, problem.basis.dofs[0], drawing, view=np.eye(3), most=frames)
    choices = scene["magnifications"]["choices"]
    enlarged = magnification or choices[scene["magnifications"]["first"]]
    scales = list(dict.fromkeys([enlarged, 1]))
    drawn = {scale: SpaceDrawing(scene, scale) for scale in scales}
    times = np.linspace(0.0, problem.duration, scene["frames"] + 1)
    clock = scale_for("s", problem.duration)
    labels = [significant(time * clock.factor, 4) for time in times]
    first = drawn[enlarged]
    view = view_of(drawing.positions, np.ptp(first.known, axis=0))
    menus = [_menu(_play(enlarged), 0.0)]
    if len(drawn) > 1:
        # Clear of the bar of tools in the other corner.
        menus.append(_menu(_scales(drawn, labels, clock.unit, view, drawing.schematic), 0.22))
    return {
        "data": first.traces(0),
        "frames": [
            {
                "name": f"{scale:g}:{number}",
                "group": f"{scale:g}",
                "data": each.moving(number),
                "traces": each.moving_traces,
            }
            for scale, each in drawn.items()
            for number in range(scene["frames"] + 1)
        ],
        "layout": {
            "title": {"text": "The motion", "x": 0.0, "xref": "paper", "y": 0.97},
            "font": {"family": FONT, "size": 13, "color": LIGHT["ink"]},
            "paper_bgcolor": LIGHT["paper"],
            "margin": {"l": 0, "r": 0, "t": 84, "b": 0},
            "height": 560,
            "showlegend": False,
            "scene": space_layout(first.bounds, view, drawing.schematic),
            "sliders": [_slider(enlarged, labels, clock.unit)],
            "updatemenus": menus,
        },
    }


def space_layout(
    bounds: tuple[FloatArray, FloatArray], view: FloatArray, schematic: bool
) -> dict[str, Any]:
    """Return the axes and the camera of a drawing in space.

    Parameters
    ----------
    bounds
        Lowest and highest coordinates, (3,) each, in m.
    view
        From where it is seen, (2, 3); see `view_of`.
    schematic
        Whether places tell nothing in m.
    """
    low, high = bounds
    camera = _camera(view)
    axes: dict[str, Any] = {}
    for name, start, end in zip("xyz", low.tolist(), high.tolist(), strict=True):
        axes[f"{name}axis"] = {
            "range": [start, end],
            "title": {"text": name if schematic else f"{name} (m)"},
            "color": LIGHT["muted"],
            "gridcolor": LIGHT["grid"],
            "showbackground": False,
            # Along the line of sight all its words would lie over each other.
            "visible": abs(camera["eye"][name]) < STRAIGHT * EYE,
        }
    wide, tall = np.abs(view) @ (high - low)
    ratio = (high - low) * min(WIDEST / wide, TALLEST / tall)
    return axes | {"aspectmode": "manual", "aspectratio": _xyz(ratio), "camera": camera}


def _camera(view: FloatArray) -> dict[str, Any]:
    """Return the camera that sees what a view (2, 3) on paper sees."""
    eye = EYE * np.cross(view[0], view[1])
    up = np.array([0.0, 0.0, 1.0]) if abs(view[1, 2]) > UPRIGHT else view[1]
    return {"eye": _xyz(eye), "up": _xyz(up), "projection": {"type": "orthographic"}}


def _xyz(vector: FloatArray) -> dict[str, float]:
    x, y, z = vector.tolist()
    return {"x": x, "y": y, "z": z}


def _slider(scale: float, labels: Sequence[str], unit: str) -> dict[str, Any]:
    now = {
        "mode": "immediate",
        "frame": {"duration": 0, "redraw": True},
        "transition": {"duration": 0},
    }
    return {
        "active": 0,
        "pad": {"t": 36, "b": 12, "l": 12, "r": 12},
        "currentvalue": {"prefix": "t = ", "suffix": f" {unit}"},
        "steps": [
            {"label": label, "method": "animate", "args": [[f"{scale:g}:{number}"], now]}
            for number, label in enumerate(labels)
        ],
    }


def _play(scale: float) -> list[dict[str, Any]]:
    pace = {"duration": FRAME_MILLISECONDS, "redraw": True}
    going = {"fromcurrent": True, "frame": pace, "transition": {"duration": 0}}
    still = {
        "mode": "immediate",
        "frame": {"duration": 0, "redraw": False},
        "transition": {"duration": 0},
    }
    return [
        {"label": "Play", "method": "animate", "args": [f"{scale:g}", going]},
        {"label": "Pause", "method": "animate", "args": [[None], still]},
    ]


def _scales(
    drawn: dict[float, SpaceDrawing],
    labels: Sequence[str],
    unit: str,
    view: FloatArray,
    schematic: bool,
) -> list[dict[str, Any]]:
    """Return a button a scale: it puts that scale's motion, time line and ranges in place."""
    buttons = []
    for scale, drawing in drawn.items():
        start = drawing.moving(0)
        restyled = {axis: [trace[axis].tolist() for trace in start] for axis in "xyz"}
        layout = {
            "sliders": [_slider(scale, labels, unit)],
            "updatemenus[0].buttons": _play(scale),
            "scene": space_layout(drawing.bounds, view, schematic),
        }
        label = "True scale" if scale == 1 else f"Motion × {scale:,g}"
        buttons.append(
            {"label": label, "method": "update", "args": [restyled, layout, drawing.moving_traces]}
        )
    return buttons


def _menu(buttons: list[dict[str, Any]], x: float) -> dict[str, Any]:
    return {
        "type": "buttons",
        "direction": "right",
        "x": x,
        "xanchor": "left",
        "y": 1.0,
        "yanchor": "bottom",
        "pad": {"b": 6},
        "showactive": len(buttons) > 1 and buttons[0]["method"] == "update",
        "buttons": buttons,
    }


def still_at_first(figure: Figure) -> go.Figure:
    """Return a plotly figure whose motion begins when it is told to.

    plotly plays all frames of a figure as soon as it is shown, those of both scales in a row.
    """
    import plotly.graph_objects as go

    class Still(go.Figure):  # type: ignore[misc]  # plotly has no types
        """A figure that does not play by itself."""

        def show(self, *args: Any, **kwargs: Any) -> Any:
            return super().show(*args, **{"auto_play": False} | kwargs)

        def to_html(self, *args: Any, **kwargs: Any) -> Any:
            return super().to_html(*args, **{"auto_play": False} | kwargs)

        def write_html(self, *args: Any, **kwargs: Any) -> Any:
            return super().write_html(*args, **{"auto_play": False} | kwargs)

        def _ipython_display_(self) -> None:
            self.show()

    return Still(figure)
