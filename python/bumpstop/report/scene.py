"""What the page needs to draw a structure and to move it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.laws.around_axis import StopAroundAxis
from bumpstop.report.carried import carried_motion
from bumpstop.report.followed import followed_motion
from bumpstop.report.law_scene import drawn_springs, law_scenes
from bumpstop.report.outline import UNSEEN, view_of
from bumpstop.report.playing import frame_times, magnifications, paces
from bumpstop.report.scales import scale_for
from bumpstop.report.words import unit_of
from bumpstop.structure.drawn import DrawnModel

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bumpstop.arguments import FloatArray
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Problem
    from bumpstop.report.outline import Outline
    from bumpstop.response import Response
    from bumpstop.structure.model import LinearModel
    from bumpstop.structure.support import Support

__all__ = ["best_view", "mode_scene", "motion_scene"]

UPRIGHT = 0.1
"""Part of Z that is up on paper where a scene is turned about it."""

_AXES = ("dx", "dy", "dz")
_TURN = ("drx", "dry", "drz")


def motion_scene(
    response: Response,
    watched: tuple[str, str],
    drawing: Outline,
    *,
    view: FloatArray | None = None,
    most: int | None = None,
) -> dict[str, Any]:
    """Return what the page plays: the drawing and the motion of one response.

    A structure with places can be turned: points, shapes and directions have a third component,
    towards the reader, and ``vertical`` is the direction about which it is turned.

    Parameters
    ----------
    response
        What to play.
    watched
        Node and dof whose displacement is drawn above the slider and told beside the time.
    drawing
        Outline of the structure; the nodes of the laws are among its points.
    view
        From global axes to those of the scene, (2 or 3, 3); where left out, those from which the
        motion is seen best.
    most
        Frames at most.
    """
    problem = response.problem
    times = frame_times(response, most)
    shapes, amplitudes = carried_motion(problem, drawing, times)
    drawing, modal = followed_motion(response, drawing, times)
    if amplitudes.shape[1]:
        drawing = replace(drawing, shapes=np.concatenate([drawing.shapes, shapes], axis=2))
        modal = np.hstack([modal, amplitudes])
    travel = np.einsum("pam,fm->fpa", drawing.shapes, modal[:: max(len(modal) // 500, 1)])
    reach = np.abs(travel).max(axis=(0, 1))
    if view is None:
        view = best_view(drawing, np.max([reach, *_directions(problem, reach)], axis=0))
    furthest = float(np.linalg.norm(travel, axis=-1).max())
    drawn = _drawing(drawing, problem.basis, view)
    extent = 0.0 if drawing.schematic else float(np.ptp(drawn["points"], axis=0).max())
    displacement = response.sample("displacement", *watched, times=times)
    scale = scale_for(unit_of("displacement", watched[1]), displacement)
    clock = scale_for("s", problem.duration)
    laws = law_scenes(response, drawing, view, times)
    force = scale_for("N", [law["forces"] for law in laws] if laws else 0.0)
    return drawn | {
        "laws": laws,
        "springs": drawn_springs(problem.basis, drawing, view),
        "magnifications": magnifications(extent, furthest),
        "duration": problem.duration,
        "frames": len(times) - 1,
        "timeScale": [clock.factor, clock.unit],
        "modal": modal,
        "forceScale": [force.factor, force.unit],
        "watched": {
            "point": drawing.nodes.get(watched[0], -1),
            "values": displacement,
            "scale": [scale.factor, scale.unit],
        },
        "paces": paces(response),
    }


def best_view(drawing: Outline, motion: FloatArray) -> FloatArray:
    """Return the axes of the scene: those of the paper, and towards the reader if it turns."""
    view = view_of(drawing.positions, motion)
    return view if drawing.schematic else np.vstack([view, np.cross(view[0], view[1])])


def _directions(problem: Problem, reach: FloatArray) -> list[FloatArray]:
    """Return the directions along which laws act, as long as the motion reaches."""
    laws = [law for law in problem.laws if law.coordinate.terms is None]
    rows = [np.array(law.coordinate.direction) for law in laws]
    for law in laws:
        if isinstance(law, StopAroundAxis):
            rows += list(law.axes[:2])
    return [np.abs(row) * float(reach.max()) for row in rows]


def mode_scene(basis: ModalBasis, drawing: Outline) -> dict[str, Any]:
    """Return what the page needs to draw each mode of a basis; see `motion_scene`.

    Only a structure in space can be turned.
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
    return drawn


def _drawing(drawing: Outline, basis: ModalBasis, view: FloatArray) -> dict[str, Any]:
    structure = basis.structure
    bodies = [mass.node for mass in structure.masses] if structure is not None else []
    # Without beams and masses the points are all there is to see, so each is drawn as a body.
    if not drawing.lines and not bodies:
        bodies = list(drawing.nodes)
    return {
        "points": drawing.positions @ view.T,
        "shapes": np.einsum("va,pam->pvm", view, drawing.shapes),
        "lines": drawing.lines,
        "nodes": [{"name": name, "point": point} for name, point in drawing.nodes.items()],
        "bodies": [drawing.nodes[node] for node in dict.fromkeys(bodies)],
        "supports": _supports(basis.model, drawing, view),
    } | ({"vertical": _upright(view)} if len(view) == 3 else {})


def _upright(view: FloatArray) -> FloatArray:
    """Return the direction about which a scene is turned: Z, or up where Z faces the reader."""
    return np.asarray(view[:, 2] if abs(view[1, 2]) > UPRIGHT else np.eye(3)[1])


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
