"""How a node moves as seen from the obstacle of a law, which may move itself."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.laws.coordinate import Coordinate, unit
from bumpstop.laws.friction import component_row
from bumpstop.laws.obstacle_motion import moved
from bumpstop.projection import TRANSLATIONS
from bumpstop.sampling import kept_rows

if TYPE_CHECKING:
    from bumpstop.laws.around_axis import StopAroundAxis
    from bumpstop.problem import Law
    from bumpstop.response import Response

__all__ = ["along_coordinates", "motion_at_obstacle", "places_at_obstacle"]


def motion_at_obstacle(
    response: Response, law: int, dofs: Sequence[str], derivative: int
) -> Callable[[FloatArray], FloatArray]:
    """Return the motion (time, dofs) of a law's node along some axes, seen from its obstacle.

    Against the node that carries the obstacle, where there is one; with what supports that move
    add to the motion of the modes, where they leave the obstacle behind, and less how an obstacle
    of a shape moves by itself.
    """
    of = response.problem.laws[law]
    contact, basis = of.coordinate, response.problem.basis
    axes = [
        Coordinate(
            contact.node, unit("dof", [float(dof == each) for each in TRANSLATIONS]), contact.other
        )
        for dof in dofs
    ]
    rows = np.array([component_row(basis, contact, dof) for dof in dofs])
    return along_coordinates(response, of, axes, rows, derivative)


def places_at_obstacle(response: Response, stop: StopAroundAxis, times: FloatArray) -> FloatArray:
    """Return where the node of a stop is in the plane of its obstacle, (time, 2), in m."""
    basis = response.problem.basis
    coordinates, rows = stop.coordinates[:2], stop.rows(basis)[:2]
    seen = along_coordinates(response, stop, coordinates, rows, 0)
    places: FloatArray = stop.origin(basis) + seen(times)
    return places


def along_coordinates(
    response: Response,
    law: Law,
    coordinates: Sequence[Coordinate],
    rows: FloatArray,
    derivative: int,
) -> Callable[[FloatArray], FloatArray]:
    """Return the motion (time, coordinates) along coordinates of a law, seen from its obstacle.

    Parameters
    ----------
    response
        The run.
    law
        The law.
    coordinates
        Along what.
    rows
        The same as the modes move along them, (coordinates, N).
    derivative
        0 for displacement, 1 for velocity.
    """
    problem, rows = response.problem, kept_rows(response, rows)
    motion = getattr(law, "motion", None)
    # A stop on a plane moves across that alone.
    own = motion if isinstance(motion, dict) else {}
    if not problem.supports_move and not own:
        return lambda times: response.motion(derivative, times) @ rows.T
    from bumpstop.carried import carried_past

    def seen(times: FloatArray) -> FloatArray:
        along = response.motion(derivative, times) @ rows.T
        along += carried_past(problem, law, coordinates, times, derivative)
        if own:
            directions = np.array([each.direction for each in coordinates])
            along -= moved(own, problem.duration, times, derivative) @ directions.T
        return along

    return seen
