"""What the page needs to draw a structure and to move it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.report.curves import contact_spans, looked_at
from bumpstop.report.outline import UNSEEN, view_of
from bumpstop.report.scales import scale_for, significant, with_unit
from bumpstop.report.stops import fixed_stops
from bumpstop.report.words import unit_of
from bumpstop.structure.drawn import DrawnModel

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bumpstop.arguments import FloatArray
    from bumpstop.laws.contact import Contact
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Problem
    from bumpstop.report.outline import Outline
    from bumpstop.response import Response
    from bumpstop.structure.model import LinearModel
    from bumpstop.structure.support import Support

__all__ = ["mode_scene", "motion_scene"]

MOST_NUMBERS = 120_000
"""Numbers in all frames of a motion; it keeps the page small."""

_AXES = ("dx", "dy", "dz")
_TURN = ("drx", "dry", "drz")
_NICE = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10_000, 100_000, 1_000_000]


def motion_scene(response: Response, watched: tuple[str, str], drawing: Outline) -> dict[str, Any]:
    """Return what the page plays: the drawing and the motion of one response.

    Parameters
    ----------
    response
        What to play.
    watched
        Node and dof whose displacement is drawn above the slider and told beside the time.
    drawing
        Outline of the structure; the nodes of the stops are among its points.
    """
    problem = response.problem
    times = _frame_times(response)
    modal = response.motion(0, times)
    travel = np.einsum("pam,fm->fpa", drawing.shapes, modal[:: max(len(modal) // 500, 1)])
    reach = np.abs(travel).max(axis=(0, 1))
    normals = [np.abs(stop.coordinate.direction) * reach.max() for stop in fixed_stops(problem)]
    view = view_of(drawing.positions, np.max([reach, *normals], axis=0))
    furthest = float(np.linalg.norm(travel @ view.T, axis=-1).max())
    drawn = _drawing(drawing, problem.basis, view)
    extent = 0.0 if drawing.schematic else float(np.ptp(drawing.positions @ view.T, axis=0).max())
    displacement = response.sample("displacement", *watched, times=times)
    scale = scale_for(unit_of("displacement", watched[1]), displacement)
    clock = scale_for("s", problem.duration)
    stops = fixed_stops(problem)
    forces = [response.sample("stop_force", stop.name, times=times) for stop in stops]
    force = scale_for("N", forces if forces else 0.0)
    return drawn | {
        "stops": [_stop(stop, drawing, view, response) for stop in stops],
        "magnifications": _magnifications(extent, furthest),
        "duration": problem.duration,
        "frames": len(times) - 1,
        "timeScale": [clock.factor, clock.unit],
        "modal": modal,
        "forces": np.array(forces),
        "contacts": [contact_spans(response, stop.name) for stop in stops],
        "forceScale": [force.factor, force.unit],
        "watched": {
            "point": drawing.nodes.get(watched[0], -1),
            "values": displacement,
            "scale": [scale.factor, scale.unit],
        },
        "paces": _paces(problem, response),
    }


def mode_scene(basis: ModalBasis, drawing: Outline) -> dict[str, Any]:
    """Return what the page needs to draw each mode of a basis; see `motion_scene`.

    A structure in space can be turned: points, shapes and normals have a third component
    then, towards the reader, and ``vertical`` is the direction of Z in these components.
    """
    reach = np.abs(drawing.shapes).max(axis=(0, 2))
    view = view_of(drawing.positions, reach)
    if drawing.spatial:
        view = np.vstack([view, np.cross(view[0], view[1])])
    drawn = _drawing(drawing, basis, view)
    shapes = drawn["shapes"]
    largest = np.linalg.norm(shapes, axis=1).max(axis=0)
    # A mode that the view does not show stays a straight line instead of amplified rounding.
    visible = largest > UNSEEN * max(float(largest.max()), np.finfo(float).tiny)
    drawn["shapes"] = shapes / np.where(visible, largest, np.inf)
    return drawn | ({"vertical": view[:, 2]} if drawing.spatial else {})


def _drawing(drawing: Outline, basis: ModalBasis, view: FloatArray) -> dict[str, Any]:
    structure = basis.structure
    masses = structure.masses if structure is not None else ()
    # Without beams the points are all there is to see, so each is drawn as a body.
    bodies = list(drawing.nodes) if not drawing.lines else [mass.node for mass in masses]
    return {
        "points": drawing.positions @ view.T,
        "shapes": np.einsum("va,pam->pvm", view, drawing.shapes),
        "lines": drawing.lines,
        "nodes": [{"name": name, "point": point} for name, point in drawing.nodes.items()],
        "bodies": [drawing.nodes[node] for node in dict.fromkeys(bodies)],
        "supports": _supports(basis.model, drawing, view),
    }


def _supports(
    model: LinearModel | None, drawing: Outline, view: FloatArray
) -> list[dict[str, Any]]:
    """Return how each node that a support names is held, as the view shows it.

    A support of all nodes alone keeps the motion in a plane or on an axis; it is not drawn.
    """
    held: dict[str, set[str]] = {}
    everywhere: set[str] = set()
    supports: Sequence[Support] = model.supports if isinstance(model, DrawnModel) else ()
    for support in supports:
        if support.nodes == "all":
            everywhere |= set(support.fixed)
        else:
            for node in support.nodes:
                held.setdefault(node, set()).update(support.fixed)
    drawn = []
    for node, fixed in held.items():
        fixed |= everywhere
        held_axes = [axis for axis, dof in enumerate(_AXES) if dof in fixed and view[:, axis].any()]
        moving_axes = [axis for axis in range(3) if axis not in held_axes and view[:, axis].any()]
        if node not in drawing.nodes or not held_axes:
            continue
        turning = {"drx", "dry", "drz"} - {_TURN[axis] for axis in range(3) if view[:, axis].any()}
        clamped = fixed.issuperset(turning or {"drx", "dry", "drz"})
        kind = "roller" if moving_axes else "clamp" if clamped else "pin"
        place = drawing.nodes[node]
        # A roller's ground lies across the direction that it holds, a wall across its beam.
        normal = np.eye(len(view))[1]
        if kind == "roller":
            normal = view[:, max(held_axes, key=lambda axis: abs(view[1, axis]))]
        elif kind == "clamp":
            normal = _away_from(drawing, view, place)
        drawn.append({"point": place, "kind": kind, "normal": normal})
    return drawn


def _away_from(drawing: Outline, view: FloatArray, place: int) -> FloatArray:
    """Return the direction on paper in which a beam leaves a node; right where none does."""
    here = drawing.positions[place]
    for first, count in drawing.lines:
        ends = drawing.positions[[first, first + count - 1]]
        for end, other in (ends, ends[::-1]):
            along = view @ (other - here)
            if np.array_equal(end, here) and np.any(along):
                return np.asarray(along / np.linalg.norm(along))
    return np.asarray(np.eye(len(view))[0])


def _stop(law: Contact, drawing: Outline, view: FloatArray, response: Response) -> dict[str, Any]:
    times = looked_at(response)
    return {
        "name": law.name,
        "label": f"{law.name}, {_give(law)}",
        "point": drawing.nodes[law.coordinate.node],
        "normal": view @ np.array(law.coordinate.direction),
        "gap": law.gap,
        "deepest": max(0.0, -float(response.sample("gap", law.name, times=times).min())),
    }


def _give(law: Contact) -> str:
    """Return how far a stop gives way, in words."""
    stiffness: float | None = getattr(law, "stiffness", None)
    if stiffness is None:
        return "rigid"
    exponent: float | None = getattr(law, "exponent", None)
    if exponent is None:
        return with_unit(stiffness, "N/m")
    return f"{significant(stiffness, 4)} N/m^{exponent:g}"


def _frame_times(response: Response) -> FloatArray:
    """Return instants evenly spread over the run: more of them where there are more impacts."""
    problem = response.problem
    numbers = len(problem.basis.omega2) + len(problem.laws) + 2
    wanted = max(1000, 40 * len(response.impact_table()["start"]))
    frames = min(wanted, max(MOST_NUMBERS // numbers, 200))
    return np.linspace(0.0, problem.duration, frames + 1)


def _magnifications(extent: float, furthest: float) -> dict[str, Any]:
    """Return by how much the motion may be magnified, and by how much it is at first."""
    if extent == 0.0 or furthest == 0.0:
        return {"choices": [1], "first": 0}
    choices = [factor for factor in _NICE if factor * furthest <= 0.6 * extent] or [1]
    fitting = [i for i, factor in enumerate(choices) if factor * furthest <= 0.3 * extent]
    return {"choices": choices, "first": fitting[-1] if fitting else 0}


def _paces(problem: Problem, response: Response) -> dict[str, Any]:
    """Return how many seconds on the screen one second of the run may take."""
    impacts = len(response.impact_table()["start"])
    screen_seconds = min(max(8.0, 0.8 * impacts), 600.0)
    usual = _nice_pace(screen_seconds / problem.duration)
    choices = [usual * factor for factor in (8.0, 4.0, 2.0, 1.0, 0.5, 0.25)]
    return {
        "choices": [{"slowdown": pace, "label": _pace_label(pace)} for pace in choices],
        "first": 3,
    }


def _nice_pace(slowdown: float) -> float:
    power = 10.0 ** np.floor(np.log10(slowdown))
    return float(power * min((1.0, 2.0, 4.0, 8.0, 10.0), key=lambda n: abs(n - slowdown / power)))


def _pace_label(slowdown: float) -> str:
    if slowdown == 1.0:
        return "real time"
    return f"{slowdown:,.6g} × slower" if slowdown > 1.0 else f"{1.0 / slowdown:,.6g} × faster"
