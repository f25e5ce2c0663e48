"""What stops on obstacles about an axis have: the axis, and the plane across it."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, Vector, finite, vector
from bumpstop.errors import InputError
from bumpstop.laws.coordinate import unit
from bumpstop.laws.shaped_stop import ACROSS, ShapedStop

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis

__all__ = ["StopAroundAxis", "plane_axes"]


@dataclass(frozen=True)
class StopAroundAxis(ShapedStop):
    """A stop on an obstacle that lies around, or beside, an axis.

    Each kind says in its own words what its obstacle is.
    """

    _: KW_ONLY
    axis: Vector
    roll: float = 0.0
    centre: Vector | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "axis", unit("axis", self.axis))
        object.__setattr__(self, "roll", finite("roll", self.roll))
        if self.centre is not None:
            object.__setattr__(self, "centre", vector("centre", self.centre))
        super().__post_init__()

    @cached_property
    def axes(self) -> FloatArray:
        """The two directions that span the plane of contact, and the axis, one a row, (3, 3).

        Without roll the first is the part of the global y axis across the axis, or that of the
        z axis where these are one; the second is the axis times it.
        """
        return plane_axes(self.axis, self.roll)

    def origin(self, basis: ModalBasis) -> FloatArray:
        """Return where the node at rest stands, seen from the obstacle's centre, (2,), in m."""
        if self.centre is not None:
            return np.asarray(-self.axes[:2] @ np.array(self.centre))
        if self.other is None:
            return np.zeros(2)
        if basis.model is None:
            what = "must be told: this basis does not know where its nodes are"
            raise InputError(what, key="centre", hint="the place of the other node from this one")
        here, there = (basis.model.position(node) for node in (self.node, self.other))
        return np.asarray(self.axes[:2] @ (np.array(here) - np.array(there)))

    @abstractmethod
    def outline(self) -> FloatArray:
        """Return points of the obstacle that the node may reach, closed, (n, 2), in m."""


def plane_axes(axis: Vector, roll: float = 0.0) -> FloatArray:
    """Return the axes of the plane across an axis, and the axis, a unit vector each, (3, 3).

    Examples
    --------
    >>> plane_axes((2.0, 0.0, 0.0)).round(12).tolist()
    [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]
    """
    along = np.array(unit("axis", axis))
    first = np.eye(3)[1 if abs(along[1]) < 1.0 - ACROSS else 2]
    first = first - (first @ along) * along
    first /= np.linalg.norm(first)
    second = np.cross(along, first)
    cos, sin = np.cos(roll), np.sin(roll)
    return np.array([cos * first + sin * second, cos * second - sin * first, along])
