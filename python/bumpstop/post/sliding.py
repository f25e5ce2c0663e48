"""How fast a node slides along the obstacle of a law."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.laws.friction import sliding_coordinate
from bumpstop.post.at_obstacle import along_coordinates, motion_at_obstacle
from bumpstop.projection import TRANSLATIONS

if TYPE_CHECKING:
    from bumpstop.laws.coordinate import Coordinate
    from bumpstop.problem import Law
    from bumpstop.response import Response

__all__ = ["sliding_speed"]


def sliding_speed(response: Response, law: int) -> Callable[[FloatArray], FloatArray]:
    """Return the speed in m/s with which a law's node moves along its obstacle, over time."""
    of = response.problem.laws[law]
    if of.coordinate.terms is not None:
        along = _sliding_of_terms(response, of)
        rows = along.row(response.problem.basis)[np.newaxis]
        return lambda times: np.abs(along_coordinates(response, of, [along], rows, 1)(times)[:, 0])
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


def _sliding_of_terms(response: Response, law: Law) -> Coordinate:
    if getattr(law, "friction", None) is None:
        what = "rubs in no known direction: its distance is a sum of dofs"
        raise InputError(what, key="stop", value=law.name)
    basis, sliding = response.problem.basis, getattr(law, "sliding", None)
    return sliding_coordinate(basis, law.coordinate, sliding)
