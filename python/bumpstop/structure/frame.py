"""Local axes of straight members, and rigid motions in space."""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray, Vector

__all__ = ["local_axes", "rigid_motions", "turned"]

_UPRIGHT = 1e-6
"""A member within this angle (rad) of the global Z counts as parallel to it."""


def local_axes(start: FloatArray, end: FloatArray, roll: FloatArray | float = 0.0) -> FloatArray:
    """Return the unit vectors of members' local axes, one a row, (..., 3, 3).

    Local x runs from ``start`` to ``end``, each (..., 3). Local z is the global Z made
    perpendicular to x, and y = z x x, so that a member along X has the global axes; for a
    member parallel to the global Z, local y is the global Y. Then y and z are turned by
    ``roll``, in rad about x.

    Examples
    --------
    >>> local_axes(np.zeros(3), np.array([0.783, 0.0, 0.0]))
    array([[1., 0., 0.],
           [0., 1., 0.],
           [0., 0., 1.]])
    """
    x = _unit(end - start)
    level = np.stack([-x[..., 1], x[..., 0], np.zeros(x.shape[:-1])], axis=-1)
    upright = np.hypot(x[..., 0], x[..., 1]) <= _UPRIGHT
    y = np.where(upright[..., np.newaxis], np.array([0.0, 1.0, 0.0]) - x[..., 1:2] * x, level)
    y = _unit(y)
    z = np.cross(x, y)
    if np.any(roll):
        cosine, sine = np.cos(roll)[..., np.newaxis], np.sin(roll)[..., np.newaxis]
        y, z = cosine * y + sine * z, cosine * z - sine * y
    axes: FloatArray = np.stack([x, y, z], axis=-2) + 0.0
    return axes


def turned(matrices: FloatArray, axes: FloatArray, *, skew: bool = False) -> FloatArray:
    """Return matrices of local dofs in global axes, exactly as symmetric as they were.

    Parameters
    ----------
    matrices
        Symmetric, with three dofs for each vector, (elements, 3 n, 3 n).
    axes
        Local axes of each element, one a row, (elements, 3, 3).
    skew
        Whether the matrices are skew-symmetric instead.
    """
    size = matrices.shape[-1]
    tall = (-1, size * size // 3, 3)
    half = (matrices.reshape(tall) @ axes).reshape(matrices.shape)
    # The second product is that of the transposed matrices, so that it is like the first.
    other = np.ascontiguousarray(np.swapaxes(half, 1, 2)).reshape(tall) @ axes
    full = np.swapaxes(other.reshape(matrices.shape), 1, 2)
    mirrored = np.swapaxes(full, 1, 2)
    symmetric: FloatArray = 0.5 * (full - mirrored if skew else full + mirrored)
    return symmetric


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


def rigid_field(
    positions: FloatArray, *, translation: Vector, rotation: Vector, about: Vector
) -> FloatArray:
    """Return a small rigid motion of points in space, (6 points,): each six dofs of one point.

    Parameters
    ----------
    positions
        Where the points are in m, (points, 3).
    translation, rotation
        Along and about the global axes, in m and rad (m/s and rad/s for a velocity).
    about
        Where the axes of rotation meet, in m.
    """
    motions = rigid_motions(positions, np.array(about, dtype=float))
    field: FloatArray = motions @ np.array([*translation, *rotation], dtype=float)
    return field


def _unit(vectors: FloatArray) -> FloatArray:
    """Return vectors of length one, exact for those along an axis."""
    length = np.hypot(np.hypot(vectors[..., 0:1], vectors[..., 1:2]), vectors[..., 2:3])
    unit: FloatArray = vectors / length
    return unit
