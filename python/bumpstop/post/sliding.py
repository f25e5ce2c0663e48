"""How a node moves as seen from the obstacle of a law, and how fast it slides along it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.laws.coordinate import Coordinate, unit
from bumpstop.laws.friction import component_row, sliding_coordinate
from bumpstop.projection import TRANSLATIONS
from bumpstop.sampling import kept_rows

if TYPE_CHECKING:
    from bumpstop.problem import Law
    from bumpstop.response import Response

__all__ = ["motion_at_obstacle", "sliding_speed"]


def sliding_speed(response: Response, law: int) -> Callable[[FloatArray], FloatArray]:
    """Return the speed in m/s with which a law's node moves along its obstacle, over time."""
    of = response.problem.laws[law]
    if of.coordinate.terms is not None:
        along = _sliding_of_terms(response, of)
        rows = along.row(response.problem.basis)[np.newaxis]
        return lambda times: np.abs(_seen(response, of, [along], rows, 1)(times)[:, 0])
    velocity = motion_at_obstacle(response, law, TRANSLATIONS, 1)
    # Few laws have it: an obstacle whose normal turns.
    around: Any = getattr(of, "sliding_speeds", None)
    if around is not None:
        place = motion_at_obstacle(response, law, TRANSLATIONS, 0)
        basis = response.problem.basis
        return lambda times: np.asarray(around(basis, place(times), velocity(times)))
    normal = np.asarray(of.coordinate.direction)

    def speed(times: FloatArray) -> FloatArray:
        seen = velocity(times)
        speeds: FloatArray = np.linalg.norm(seen - np.outer(seen @ normal, normal), axis=1)
        return speeds

    return speed


def motion_at_obstacle(
    response: Response, law: int, dofs: Sequence[str], derivative: int
) -> Callable[[FloatArray], FloatArray]:
    """Return the motion (time, dofs) of a law's node along some axes, seen from its obstacle.

    Against the node that carries the obstacle, where there is one; with what supports that move
    add to the motion of the modes, where they leave the obstacle behind.
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
    return _seen(response, of, axes, rows, derivative)


def _seen(
    response: Response,
    law: Law,
    coordinates: Sequence[Coordinate],
    rows: FloatArray,
    derivative: int,
) -> Callable[[FloatArray], FloatArray]:
    problem, rows = response.problem, kept_rows(response, rows)
    if not problem.supports_move:
        return lambda times: response.motion(derivative, times) @ rows.T
    from bumpstop.carried import carried_past

    def motion(times: FloatArray) -> FloatArray:
        carried = carried_past(problem, law, coordinates, times, derivative)
        return response.motion(derivative, times) @ rows.T + carried

    return motion


def _sliding_of_terms(response: Response, law: Law) -> Coordinate:
    if getattr(law, "friction", None) is None:
        what = "rubs in no known direction: its distance is a sum of dofs"
        raise InputError(what, key="stop", value=law.name)
    basis, sliding = response.problem.basis, getattr(law, "sliding", None)
    return sliding_coordinate(basis, law.coordinate, sliding)
