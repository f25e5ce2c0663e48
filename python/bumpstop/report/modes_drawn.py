"""The shapes of modes in space, as a plotly figure."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.errors import InputError
from bumpstop.report.figures import as_plotly
from bumpstop.report.outline import outline, view_of
from bumpstop.report.palette import LIGHT
from bumpstop.report.plotting import FONT
from bumpstop.report.tables import modes

if TYPE_CHECKING:
    import plotly.graph_objects as go

    from bumpstop.arguments import FloatArray
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.report.outline import Outline

__all__ = ["draw_modes"]

LARGEST = 0.15
"""How far a mode moves on the drawing, relative to the size of the structure."""


def draw_modes(basis: ModalBasis) -> go.Figure:
    """Draw the shapes of the modes of a basis in space; a slider chooses the mode.

    Each is as large as the drawing has room for: a shape has no size of its own.

    Raises
    ------
    InputError
        If it is no basis, or has no modes, as a full model.

    Examples
    --------
    >>> import bumpstop as bs
    >>> basis = bs.ModalBasis.from_modes(frequency=[2.0, 5.0], shapes={("P", "dx"): [1.0, 1.0],
    ...                                  ("Q", "dx"): [1.0, -1.0]})
    >>> [step.label for step in draw_modes(basis).layout.sliders[0].steps]
    ['1', '2']
    """
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.report.space import space_layout

    if not isinstance(basis, ModalBasis):
        raise InputError("must be a ModalBasis", key="basis", value=type(basis).__name__)
    basis.require_modes("basis")
    drawing = outline(basis)
    size = float(np.ptp(drawing.positions, axis=0).max()) or 1.0
    travel = np.linalg.norm(drawing.shapes, axis=1).max(axis=0)
    moved = drawing.shapes * (LARGEST * size / np.where(travel > 0.0, travel, np.inf))
    shapes = drawing.positions[:, :, np.newaxis] + moved
    titles = [row["title"] for row in modes(basis, drawing.seen)]
    view = view_of(drawing.positions, np.abs(drawing.shapes).max(axis=(0, 2)))
    reached = np.concatenate([drawing.positions, *np.moveaxis(shapes, 2, 0)])
    bounds = reached.min(axis=0) - 0.1 * size, reached.max(axis=0) + 0.1 * size
    still = _traces(drawing, drawing.positions, "axis", "dash")
    count = len(titles)
    data = [*still, *(each for n in range(count) for each in _traces(drawing, shapes[:, :, n]))]
    for number, trace in enumerate(data[len(still) :]):
        trace["visible"] = number // len(still) == 0
    steps = [
        {
            "label": str(number + 1),
            "method": "update",
            "args": [
                {"visible": [True] * len(still)
                 + [n == number for n in range(count) for _ in still]},
                {"title.text": titles[number]},
            ],
        }
        for number in range(count)
    ]  # fmt: skip
    layout: dict[str, Any] = {
        "title": {"text": titles[0], "x": 0.0, "xref": "paper"},
        "font": {"family": FONT, "size": 13, "color": LIGHT["ink"]},
        "paper_bgcolor": LIGHT["paper"],
        "margin": {"l": 0, "r": 0, "t": 56, "b": 0},
        "height": 520,
        "showlegend": False,
        "scene": space_layout(bounds, view, drawing.schematic),
        "sliders": [{"active": 0, "currentvalue": {"prefix": "Mode "}, "steps": steps}],
    }
    return as_plotly({"data": data, "layout": layout})


def _traces(
    drawing: Outline, places: FloatArray, role: str = "computed", dash: str = "solid"
) -> list[dict[str, Any]]:
    """Return the beams and the nodes at some places."""
    gap = np.full((1, 3), np.nan)
    parts = [p for first, n in drawing.lines for p in (places[first : first + n], gap)]
    lines = np.concatenate([*parts, gap]).astype(np.float32)
    nodes = places[list(drawing.nodes.values())].astype(np.float32)
    line = {"color": LIGHT[role], "width": 2 if dash == "dash" else 6, "dash": dash}
    shared = {"type": "scatter3d", "hoverinfo": "skip"}
    return [
        shared | dict(zip("xyz", lines.T, strict=True)) | {"mode": "lines", "line": line},
        shared
        | dict(zip("xyz", nodes.T, strict=True))
        | {"mode": "markers", "marker": {"size": 4, "color": LIGHT[role]}}
        | {"text": list(drawing.nodes), "hoverinfo": "text"},
    ]
