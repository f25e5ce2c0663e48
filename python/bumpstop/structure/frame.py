"""Local axes of a straight member, and its rigid motions in space."""

from __future__ import annotations

import math

import numpy as np

from bumpstop.arguments import FloatArray

__all__ = ["local_axes", "rigid_motions"]

_UPRIGHT = 1e-6
"""A member within this angle (rad) of the global Z counts as parallel to it."""


def local_axes(start: FloatArray, end: FloatArray) -> FloatArray:
    """Return the unit vectors of a member's local axes, one a row, (3, 3).

    Local x runs from ``start`` to ``end``. Local z is the global Z made perpendicular to x,
    and y = z x x, so that a member along X has the global axes; for a member parallel to
    the global Z, local y is the global Y.

    Examples
    --------
    >>> local_axes(np.zeros(3), np.array([0.783, 0.0, 0.0]))
    array([[1., 0., 0.],
           [0., 1., 0.],
           [0., 0., 1.]])
    """
    x = _unit(end - start)
    if math.hypot(x[0], x[1]) > _UPRIGHT:
        y = _unit(np.array([-x[1], x[0], 0.0]))
    else:
        y = _unit(np.array([0.0, 1.0, 0.0]) - x[1] * x)
    return np.array([x, y, np.cross(x, y)]) + 0.0


def rigid_motions(positions: FloatArray, about: FloatArray) -> FloatArray:
    """Return the six rigid motions of points in space, (6 points, 6).

    Columns are unit translations along, and then unit (small) rotations about, the global
    axes through ``about``; rows are the six dofs of each point of ``positions``, (points, 3).
    """
    x, y, z = (positions - about).T
    motions = np.zeros((len(positions), 6, 6))
    motions[:, range(6), range(6)] = 1.0
    motions[:, 2, 3], motions[:, 1, 3] = y, -z
    motions[:, 0, 4], motions[:, 2, 4] = z, -x
    motions[:, 1, 5], motions[:, 0, 5] = x, -y
    return motions.reshape(-1, 6)


def _unit(vector: FloatArray) -> FloatArray:
    """Return a vector of length one, exact for a vector along an axis."""
    return vector / math.hypot(*vector)
