"""Rotations in space."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from bumpstop.arguments import FloatArray, Vector, finite, vector
from bumpstop.errors import InputError

__all__ = ["Rotation", "Turn", "rotation_matrix"]

_ROUNDING = 1e-9
"""How far a matrix may be from a rotation, in its entries; it is used as it is."""


@dataclass(frozen=True)
class Rotation:
    """A rotation about an axis through the origin, right-handed.

    Parameters
    ----------
    axis
        Direction of the axis, of any length but zero.
    angle
        In rad. Whole quarter turns about a coordinate axis are exact.

    Raises
    ------
    InputError
        If the axis has no length or a number is not finite.

    Examples
    --------
    >>> Rotation(axis=(0, 0, 1), angle=math.pi / 2).matrix
    array([[ 0., -1.,  0.],
           [ 1.,  0.,  0.],
           [ 0.,  0.,  1.]])
    """

    axis: Vector
    angle: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "axis", vector("axis", self.axis))
        object.__setattr__(self, "angle", finite("angle", self.angle))
        if not any(self.axis):
            raise InputError("must have a length", key="axis", value=self.axis)

    @property
    def matrix(self) -> FloatArray:
        """The matrix (3, 3) that turns a vector: Rodrigues' formula."""
        largest = max(map(abs, self.axis))
        scaled = [part / largest for part in self.axis]
        x, y, z = np.array(scaled) / math.hypot(*scaled)
        across = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        cosine, sine = _snapped(math.cos(self.angle)), _snapped(math.sin(self.angle))
        along = np.outer([x, y, z], [x, y, z])
        turned: FloatArray = cosine * np.eye(3) + sine * across + (1.0 - cosine) * along
        return turned + 0.0


Turn: TypeAlias = Rotation | Sequence[Sequence[float]] | FloatArray
"""A rotation as users give it: about an axis, or as a matrix (3, 3)."""


def rotation_matrix(key: str, value: Turn | None) -> FloatArray:
    """Return a user's rotation as a matrix (3, 3); the identity for None.

    Raises
    ------
    InputError
        If it is no rotation: not 3 by 3, not orthogonal, or a reflection.

    Examples
    --------
    >>> rotation_matrix("rotation", [[1, 0, 0], [0, 1, 0], [0, 0, -1]])
    Traceback (most recent call last):
    bumpstop.errors.InputError: rotation: mirrors the component; a component can be turned only
    """
    if value is None:
        return np.eye(3)
    if isinstance(value, Rotation):
        return value.matrix
    if not isinstance(value, list | tuple | np.ndarray) or len(value) != 3:
        raise InputError("must be a Rotation or a matrix of 3 by 3", key=key, value=value)
    matrix = np.array([vector(f"{key}[{row}]", line) for row, line in enumerate(value)])
    if np.abs(matrix @ matrix.T - np.eye(3)).max() > _ROUNDING:
        hint = "its rows must be perpendicular unit vectors"
        raise InputError("is not a rotation", key=key, value=matrix.tolist(), hint=hint)
    if np.linalg.det(matrix) < 0.0:
        raise InputError("mirrors the component; a component can be turned only", key=key)
    return matrix


def _snapped(value: float) -> float:
    """Return a sine or cosine, exact where the angle is a whole number of quarter turns."""
    nearest = round(value)
    return float(nearest) if abs(value - nearest) < 1e-15 else value
