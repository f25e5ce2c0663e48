"""Shapes that a node can run against."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bumpstop.arguments import FloatArray, Vector, finite
from bumpstop.laws.coordinate import unit

__all__ = ["Plane"]


@dataclass(frozen=True)
class Plane:
    """A flat wall.

    Parameters
    ----------
    normal
        Direction along which the wall pushes the structure, in global axes. Any length but
        zero; it is kept as a unit vector.
    gap
        Distance in m between node and wall where the structure is undeformed; below zero
        where the wall presses already.

    Raises
    ------
    InputError
        If the normal has no length or a number is not finite.

    Examples
    --------
    >>> wall = Plane(normal=(0, 2, 0), gap=1e-3)
    >>> wall.normal
    (0.0, 1.0, 0.0)
    >>> wall.distance([0.0, -2e-3, 0.0]).item()
    -0.001
    """

    normal: Vector
    gap: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "normal", unit("normal", self.normal))
        object.__setattr__(self, "gap", finite("gap", self.gap))

    def distance(self, displacement: FloatArray | list[float]) -> FloatArray:
        """Return ``gap + normal . displacement`` in m, for displacements (..., 3) in m."""
        return np.asarray(self.gap + np.asarray(displacement) @ np.asarray(self.normal))
