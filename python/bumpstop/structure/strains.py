"""Which sums of its dofs a stiffness matrix resists."""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.echelon import row_space
from bumpstop.structure.frame import rigid_motions

__all__ = ["strains_of"]

_CANCELLED = 1e-12
"""Forces this small beside the sizes of their terms are rounding."""


def strains_of(stiffness: FloatArray, places: FloatArray) -> FloatArray | None:
    """Return independent sums of an element's dofs that it resists, (sums, 6 m).

    Parameters
    ----------
    stiffness
        Its stiffness matrix, (6 m, 6 m).
    places
        Coordinates of its nodes in m, (m, 3).

    Returns
    -------
    sums
        None where it resists all but the motions of a rigid body.
    """
    diagonal = np.abs(stiffness.diagonal())
    scale = np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    sums = row_space(stiffness / np.outer(scale, scale)) * scale
    if len(sums) == len(stiffness) - 6 and _lets_bodies_move(stiffness, places):
        return None
    return sums


def _lets_bodies_move(stiffness: FloatArray, places: FloatArray) -> bool:
    motions = rigid_motions(places, places[0])
    forces = np.abs(stiffness @ motions)
    sizes = np.abs(stiffness) @ np.abs(motions)
    return not np.any(forces > _CANCELLED * sizes)
