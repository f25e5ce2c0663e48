"""How a scene draws laws and springs: obstacles, what joins two nodes, and what they do in time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.errors import InputError
from bumpstop.laws.around_axis import StopAroundAxis
from bumpstop.post.at_obstacle import places_at_obstacle
from bumpstop.projection import TRANSLATIONS
from bumpstop.report.curves import contact_spans
from bumpstop.report.followed import known_basis
from bumpstop.report.orbit import along_axis
from bumpstop.report.scales import significant, with_unit

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Law, Problem
    from bumpstop.report.outline import Outline
    from bumpstop.response import Response
    from bumpstop.structure.spring import Spring

__all__ = ["drawn_springs", "law_nodes", "law_scenes", "undrawn_laws"]

SYMBOLS = {
    "BucklingStop": "strut",
    "HertzStop": "sphere",
    "RigidStop": "rigid",
    "SpringLaw": "spring",
    "HardeningSpring": "spring",
    "DamperLaw": "damper",
    "ZenerDamper": "damper",
    "SeismicDevice": "device",
    "CrackedRotor": "device",
    "ForceRelation": "device",
    "UserLaw": "device",
    "OutsideProgram": "device",
}
"""What stands for a law; a coil spring for all others."""
NEAR = 3.0
"""An obstacle is drawn within so many times the farthest place of its node."""
FINE = 20_001
"""Points of a circle of which only a near arc is drawn."""
MOST_OUTLINE = 240


def law_nodes(problem: Problem) -> list[str]:
    """Return the nodes and points that the laws of a problem act on."""
    pairs = [(law.coordinate.node, law.coordinate.other) for law in problem.laws]
    return [node for pair in pairs for node in pair if node is not None]


def undrawn_laws(problem: Problem) -> list[str]:
    """Return the names of the laws that no picture shows: those along sums of dofs."""
    return [law.name for law in problem.laws if law.coordinate.terms is not None]


def law_scenes(
    response: Response, drawing: Outline, view: FloatArray, times: FloatArray
) -> list[dict[str, Any]]:
    """Return how each law is drawn, and its forces and distances in every frame.

    Parameters
    ----------
    response
        The run.
    drawing
        Outline of the structure, with the nodes of the laws.
    view
        From global axes to those of the scene, (2 or 3, 3).
    times
        Instants of the frames in s, (f,).
    """
    drawn = []
    for law in response.problem.laws:
        if law.coordinate.terms is not None:
            continue
        other = law.coordinate.other
        scene = {
            "name": law.name,
            "label": ", ".join(dict.fromkeys([law.name, _give(law)])),
            "symbol": SYMBOLS.get(type(law).__name__, "spring"),
            "point": drawing.nodes[law.coordinate.node],
            "other": -1 if other is None else drawing.nodes[other],
            "normal": view @ np.array(law.coordinate.direction),
            "forces": response.sample("stop_force", law.name, times=times),
            "contacts": contact_spans(response, law.name) if law.table == "stops" else [],
        }
        if isinstance(law, StopAroundAxis):
            scene |= {"kind": "round"} | _round(law, response, view, times)
        elif law.table == "stops":
            scene |= {"kind": "plane"} | _plane(law, response, times)
            scene |= _slider(law, response, view, times)
        else:
            scene |= {"kind": "link"}
        drawn.append(scene)
    return drawn


def drawn_springs(basis: ModalBasis, drawing: Outline, view: FloatArray) -> list[dict[str, Any]]:
    """Return how the springs of a structure are drawn: all but those that only turn."""
    structure = basis.structure
    drawn = []
    for spring in structure.springs if structure is not None else ():
        if spring.node not in drawing.nodes or spring.other not in {None, *drawing.nodes}:
            continue
        point = drawing.nodes[spring.node]
        along = _spring_direction(spring)
        if along is None:
            continue
        seen = view @ along
        if spring.other is None and _outwards(drawing, view, point) @ seen < 0.0:
            seen = -seen
        drawn.append(
            {
                "name": spring.name,
                "symbol": "damper" if spring.stiffness is None else "spring",
                "point": point,
                "other": -1 if spring.other is None else drawing.nodes[spring.other],
                "normal": seen,
            }
        )
    return drawn


def _plane(law: Law, response: Response, times: FloatArray) -> dict[str, Any]:
    """Return where the surface of a plane obstacle is, along its normal, from the node at rest."""
    gaps = response.sample("gap", law.name, times=times)
    moved = _along(response, law, np.array(law.coordinate.direction), times)
    surface = moved - gaps
    deepest = max(0.0, -float(gaps.min()))
    scene = {"gaps": gaps, "surface": float(surface[0]), "lowest": float(surface.min()) - deepest}
    still = float(np.ptp(surface)) <= 1e-9 * float(np.abs(gaps).max() + np.abs(moved).max())
    return scene if still else scene | {"surfaces": surface}


def _slider(law: Law, response: Response, view: FloatArray, times: FloatArray) -> dict[str, Any]:
    """Return where the slider of friction stands along the obstacle, in every frame.

    It is NaN while there is none; nothing is returned of stops without, and of those whose
    sliding no one direction tells.
    """
    if "anchor" not in getattr(law, "internal_variables", ()):
        return {}
    from bumpstop.laws.friction import sliding_coordinate

    basis = response.problem.basis
    along = sliding_coordinate(basis, law.coordinate, getattr(law, "sliding", None))
    if along.terms is not None:
        return {}
    places = response.sample("internal_variable", law.name, "anchor", times=times)
    return {"slider": {"direction": view @ np.array(along.direction), "places": places}}


def _along(response: Response, law: Law, direction: FloatArray, times: FloatArray) -> FloatArray:
    """Return how far the node of a law moves along a direction, (time,), in m."""
    node = law.coordinate.node
    moved = np.zeros(len(times))
    for dof, part in zip(TRANSLATIONS, direction.tolist(), strict=True):
        if part == 0.0:
            continue
        try:
            moved += part * response.sample("displacement", node, dof, times=times)
        except InputError:  # a basis made by hand need not know every direction
            continue
    return moved


def _round(
    law: StopAroundAxis, response: Response, view: FloatArray, times: FloatArray
) -> dict[str, Any]:
    """Return an obstacle about an axis as seen from its node at rest, and the force in space."""
    basis = known_basis(response)
    places = places_at_obstacle(response, law, times)
    origin = law.origin(basis)
    outline = _near(law, places)
    forces = response.history.law_forces(response.law_index(law.name), times)
    plane = view @ law.axes[:2].T
    return {
        "outline": (outline - origin) @ plane.T,
        "axis": view @ law.axes[2],
        "slides": _along(response, law, law.axes[2], times),
        "vectors": forces @ (view @ law.axes[: forces.shape[1]].T).T,
        "orbit": {
            "outline": outline,
            "places": places,
            "pushes": np.ascontiguousarray(forces[:, :2]),
            "axes": [along_axis(direction) for direction in law.axes[:2]],
        },
    }


def _near(law: StopAroundAxis, places: FloatArray) -> FloatArray:
    """Return the part of an obstacle's outline that is near the places of its node, (n, 2)."""
    outline = law.outline()
    inside = getattr(law, "side", "inside") == "inside"
    if not inside:
        turn = np.linspace(0.0, 2.0 * np.pi, FINE)
        outline = float(np.hypot(*outline[0])) * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        middle = places.mean(axis=0)
        away = float(np.hypot(*middle)) - float(np.hypot(*outline[0]))
        reach = NEAR * max(float(np.hypot(*(places - middle).T).max()), abs(away))
        near = outline[np.hypot(*(outline - middle).T) <= reach]
        if len(near):
            # From one end of the arc to the other, also where it goes through the first point.
            angles = np.arctan2(*(near @ _turned(middle))[:, ::-1].T)
            outline = near[np.argsort(angles, kind="stable")]
    step = -(-len(outline) // MOST_OUTLINE)
    return np.vstack([outline[:-1:step], outline[-1:]])


def _turned(direction: FloatArray) -> FloatArray:
    """Return the turn (2, 2) that brings a direction onto the first axis."""
    x, y = direction / max(float(np.hypot(*direction)), np.finfo(float).tiny)
    return np.array([[x, -y], [y, x]])


def _spring_direction(spring: Spring) -> FloatArray | None:
    """Return the direction in which a spring is stiffest; None where it only turns."""
    from bumpstop.structure.tensors import unit_axes

    constants = spring.stiffness if spring.stiffness is not None else spring.damping
    axes = unit_axes(spring.axes)
    sizes = np.atleast_1d(np.array(constants, dtype=float))
    if sizes.ndim == 2:
        sizes = np.diag(sizes)
    if spring.other is not None or sizes.size == 1:
        return np.asarray(axes[0])
    stiffest = int(np.argmax(np.abs(sizes[:3])))
    return np.asarray(axes[stiffest]) if sizes[stiffest] else None


def _outwards(drawing: Outline, view: FloatArray, point: int) -> FloatArray:
    """Return the direction from a node into the structure; up and right where it is alone."""
    into = view @ (drawing.positions.mean(axis=0) - drawing.positions[point])
    alone = np.array([1e-3, 1.0, 0.0])[: len(view)]
    return np.asarray(into + 1e-6 * (float(np.abs(into).max()) + 1e-30) * alone)


def _give(law: Law) -> str:
    """Return how far a law gives way, in words."""
    kind: str | None = getattr(law, "kind", None)
    if kind is not None:
        return kind
    if hasattr(law, "critical_force"):
        return f"buckles at {with_unit(law.critical_force, 'N')}"
    stiffness: float | None = getattr(law, "stiffness", None)
    if stiffness is None:
        return "rigid"
    exponent: float | None = getattr(law, "exponent", None)
    if exponent is None:
        return with_unit(stiffness, "N/m")
    return f"{significant(stiffness, 4)} N/m^{exponent:g}"
