"""One variant on the page: its figures, its motion and its tables."""

from __future__ import annotations

from html import unescape
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.laws.around_axis import StopAroundAxis
from bumpstop.post.results.reading import read_result
from bumpstop.report import figures, tables
from bumpstop.report.followed import unknown_places
from bumpstop.report.law_scene import undrawn_laws
from bumpstop.report.loops import force_loop, friction_loop
from bumpstop.report.orbit import orbit
from bumpstop.report.published import published
from bumpstop.report.scene import motion_scene

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import xarray as xr

    from bumpstop.post.references import Check, Reference
    from bumpstop.post.results.reading import Result
    from bumpstop.problem import Problem
    from bumpstop.report.figures import Figure
    from bumpstop.report.outline import Outline
    from bumpstop.response import Response

__all__ = ["MOST_STOPS", "Variant", "caption", "untitled", "watched_places"]

MOST_PLACES = 4
MOST_STOPS = 8
"""So many watched nodes, and stops and gauges, get figures; more would be a wall of paper."""

_AXES = ("dx", "dy", "dz")


class Variant:
    """The figures and the motion of one variant.

    Parameters
    ----------
    identity
        What its elements on the page are called.
    response
        What came out.
    references
        Published values; they are drawn on the figures.
    drawing
        Outline of the structure.
    results
        What else the case asks for.
    """

    def __init__(
        self,
        identity: str,
        response: Response,
        references: Sequence[Reference],
        drawing: Outline,
        results: Sequence[Result] = (),
    ) -> None:
        self.identity = identity
        self.response = response
        self.places = watched_places(response.problem, references)
        self.readings = {result.name: read_result(result, response) for result in results}
        self.drawing = drawing
        self.scene = motion_scene(response, self.places[0], drawing)
        self.figures = {
            f"{identity}-figure-{number}": figure
            for number, figure in enumerate(self._drawn(references), start=1)
        }

    def content(self, checks: Sequence[Check]) -> dict[str, Any]:
        """Return what the template fills in."""
        main_figure, *others = (caption(name, figure) for name, figure in self.figures.items())
        return {
            "id": self.identity,
            "motion": self._motion(),
            "main_figure": main_figure,
            "figures": others,
            "published": published(checks),
            "sources": list(dict.fromkeys(check.source for check in checks if check.source)),
            "results": tables.results(self.readings),
            "impacts": tables.impacts(self.response) if self.response.problem.stop_names else None,
        }

    def plots(self) -> dict[str, Figure]:
        """Return the figures as the page draws them: their headings stand in the captions."""
        return {name: untitled(figure) for name, figure in self.figures.items()}

    def _drawn(self, references: Sequence[Reference]) -> Iterator[Figure]:
        """Yield the figures, the most important one first."""
        response, problem = self.response, self.response.problem
        for place in self.places:
            yield figures.node_motion(response, "displacement", *place, references)
        for quantity in ("velocity", "acceleration"):
            published = [r.target[1:] for r in references if r.quantity == quantity]
            for node, dof in dict.fromkeys(published):
                yield figures.node_motion(response, quantity, str(node), str(dof), references)
        for law in problem.laws[:MOST_STOPS]:
            yield figures.stop_force(response, law.name, references)
            if getattr(law, "friction", None) is not None:
                yield figures.friction_force(response, law.name, references)
            yield figures.gap(response, law.name, references)
            if len(response.impact_table()["start"]) or law.table != "stops":
                yield force_loop(response, law.name)
            if getattr(law, "friction", None) is not None and hasattr(law, "sliding_row"):
                yield friction_loop(response, law.name)
            if isinstance(law, StopAroundAxis):
                yield orbit(response, law)
        for gauge in problem.gauges[:MOST_STOPS]:
            yield figures.gauge_strain(response, gauge.name, references)
        yield figures.phase_portrait(response, *self.places[0])
        yield figures.energy_ledger(response)
        for reading in self.readings.values():
            for array, log in reading.figures:
                yield _array_drawn(array, log)

    def _motion(self) -> dict[str, Any]:
        """Return what stands around the moving picture."""
        node, dof = self.places[0]
        problem, scene = self.response.problem, self.scene
        stops = bool(problem.stop_names)
        magnifications, paces = scene["magnifications"], scene["paces"]
        magnified = len(magnifications["choices"]) > 1
        return {
            "upright": not scene["lines"],
            "note": " ".join(self._motion_notes(magnified, stops)),
            "label": "The structure moving against its stops" if stops else "The structure moving",
            "turns": "vertical" in scene,
            "orbits": any("orbit" in law for law in scene["laws"]),
            "watched": f"{dof} of {node}",
            "has_laws": bool(scene["laws"]),
            "has_stops": stops,
            "magnifications": [f"{factor:,}" for factor in magnifications["choices"]],
            "magnification": magnifications["first"],
            "paces": [pace["label"] for pace in paces["choices"]],
            "pace": paces["first"],
        }

    def _motion_notes(self, magnified: bool, stops: bool) -> Iterator[str]:
        """Yield what is to be known of the moving picture, a sentence each."""
        node, dof = self.places[0]
        yield "Motion and gaps are magnified alike." if magnified else "Drawn to scale."
        yield f"The curve is {dof} of {node}{'; shaded while a stop is closed.' if stops else '.'}"
        if "vertical" in self.scene:
            yield "Drag it, or use the arrow keys on it, to turn it."
        if unknown_places(self.response, self.drawing).any():
            yield (
                "The run has kept the motion of a few dofs alone: beams that need others are drawn "
                "as they are at rest."
            )
        undrawn = undrawn_laws(self.response.problem)
        if undrawn:
            yield f"Not drawn, since no one direction tells it: {', '.join(undrawn)}."


def _array_drawn(array: xr.DataArray, log: str) -> Figure:
    """Return the figure of what a result reads: around its circle what is told by sectors."""
    if array.dims == ("angle",):
        from bumpstop.report.sectors import sector_figure

        return sector_figure(array)
    from bumpstop.report.arrays import array_figure

    return array_figure(array, log=log)


def watched_places(problem: Problem, references: Sequence[Reference]) -> list[tuple[str, str]]:
    """Return the nodes and dofs worth a figure, the most interesting one first.

    Those with published displacements, those asked for as outputs, those of the stops; where
    there are none, the one that the modes move most.
    """
    places = [
        (str(reference.node), str(reference.dof))
        for reference in references
        if reference.quantity == "displacement"
    ]
    places += problem.outputs
    places += [law.coordinate.main_dof for law in problem.laws]
    if not places:
        most = np.argmax(np.abs(problem.basis.shapes).sum(axis=1))
        places = [problem.basis.dofs[int(most)]]
    return list(dict.fromkeys(places))[:MOST_PLACES]


def caption(name: str, figure: Figure) -> dict[str, str]:
    """Return what the template puts above a figure, and how it is called."""
    layout = figure["layout"]
    # plotly's texts are HTML; the template escapes them again.
    title = unescape(layout["title"]["text"])
    label = f"Plot of {title}, around its circle"
    if "polar" not in layout:
        across, up = (unescape(layout[axis]["title"]["text"]) for axis in ("xaxis", "yaxis"))
        label = f"Plot of {up} against {across}"
    return {
        "id": name,
        "title": title,
        "note": unescape(layout["title"].get("subtitle", {}).get("text", "")),
        "label": label,
    }


def untitled(figure: Figure) -> Figure:
    """Return a figure without its heading, which stands in its caption."""
    layout = {key: value for key, value in figure["layout"].items() if key != "title"}
    # A circle has words above it, and others a legend.
    top = 40 if layout.get("showlegend", True) or "polar" in layout else 12
    return {"data": figure["data"], "layout": layout | {"margin": layout["margin"] | {"t": top}}}
