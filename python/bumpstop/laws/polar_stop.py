"""PolarStop: unilateral contact with an obstacle whose profile is given by points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray, listed, pair
from bumpstop.errors import InputError
from bumpstop.laws.around_axis import StopAroundAxis

if TYPE_CHECKING:
    from bumpstop import _core

__all__ = ["PolarStop"]

MOST = 65_535
"""Corners that the core can count."""


@dataclass(frozen=True)
class PolarStop(StopAroundAxis):
    """An obstacle around the node whose profile r(angle) is a closed polygon.

    In the plane across the axis each side of the polygon belongs to the sector between the rays
    to its ends; there the stop is that of a plane, with ``F = max(0, -stiffness d - damping d')``
    along the side's normal while the node is beyond the side, d < 0. Where a node crosses a ray
    while it is pressed in, the depth may change at once, and the energy that this takes or gives
    is that of the stop in the ledger. Friction acts as in a `CircleStop`, along the side and
    along the axis.

    Parameters
    ----------
    name, node, axis, roll, other, centre, stiffness, damping
        As in a `CircleStop`; angles count from the first direction of the plane about the axis.
    friction, tangential_stiffness, tangential_damping, motion, frame
        As in a `CircleStop`.
    profile
        Corners (angle, radius), in rad and m: three at least, the angles increasing over less
        than a full turn, each less than half a turn after the one before. The last corner is
        joined to the first.

    Raises
    ------
    InputError
        As a `CircleStop`; if the corners are too few, out of order, or leave the centre outside.

    References
    ----------
    The sectors are those of the obstacle ``DISCRET`` of code_aster's manual U4.44.21.

    Examples
    --------
    A square hole of 2 mm is four planes.

    >>> import bumpstop as bs
    >>> from math import pi, sqrt
    >>> corners = [((2 * n + 1) * pi / 4, sqrt(2) * 1e-3) for n in range(4)]
    >>> hole = bs.PolarStop("hole", node="P", axis=(1, 0, 0), profile=corners, stiffness=1e6)
    >>> shapes = {("P", "dy"): [1.0, 0.0], ("P", "dz"): [0.0, 1.0]}
    >>> tube = bs.ModalBasis.from_modes(frequency=[0, 0], damping=[0, 0], shapes=shapes)
    >>> thrown = bs.ModalState(velocity=[0.0, 0.5])
    >>> run = bs.simulate(bs.Problem(tube, laws=[hole], initial=thrown, duration=6e-3))
    >>> print(f"{run.impact_table()['start'][0]:.6f} s")
    0.002000 s
    """

    smooth: ClassVar[str] = "its obstacle is a polygon"
    obstacle: ClassVar[str] = "polygon"

    _: KW_ONLY
    profile: Sequence[tuple[float, float]]

    def __post_init__(self) -> None:
        super().__post_init__()
        corners = tuple(pair("profile", each) for each in listed("profile", self.profile))
        object.__setattr__(self, "profile", corners)
        if not 3 <= len(corners) <= MOST:
            what = f"must have 3 to {MOST:,} corners"
            raise InputError(what, key="profile", value=f"{len(corners)} corners")
        angles = np.array([angle for angle, _ in corners])
        steps = np.diff(angles, append=angles[0] + 2.0 * np.pi)
        wrong = np.flatnonzero((steps <= 0.0) | (steps >= np.pi))
        if len(wrong):
            what = "must have angles that increase, by less than half a turn, over one turn"
            told = corners[int(wrong[0])]
            raise InputError(what, key=f"profile[{int(wrong[0])}]", value=told)
        for number, (_, radius) in enumerate(corners):
            if radius <= 0.0:
                what = "must have a positive radius"
                raise InputError(what, key=f"profile[{number}]", value=corners[number])

    @cached_property
    def corners(self) -> FloatArray:
        """Places of the corners in the plane of contact, (n, 2), in m."""
        angles, radii = np.array(self.profile).T
        return np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=1)

    @cached_property
    def _sides(self) -> tuple[FloatArray, FloatArray]:
        """Unit vectors outwards, (n, 2), and distances from the centre, (n,), of all sides."""
        ahead = np.roll(self.corners, -1, axis=0)
        along = ahead - self.corners
        outwards = np.stack([along[:, 1], -along[:, 0]], axis=1)
        outwards /= np.linalg.norm(outwards, axis=1)[:, np.newaxis]
        return outwards, (outwards * self.corners).sum(axis=1)

    def shape(self) -> _core.Shape:
        """Return the obstacle as the core sees it."""
        from bumpstop import _core

        return _core.Shape.polygon([(float(y), float(z)) for y, z in self.corners])

    def outline(self) -> FloatArray:
        """Return the corners of the profile, closed, (n, 2), in m."""
        return np.asarray(np.vstack([self.corners, self.corners[:1]]))

    def distances(self, places: FloatArray) -> FloatArray:
        """Return the distances of places from the side of their sector, (n, 2), in m."""
        outwards, reach = self._sides
        side = self._side(places)
        return np.asarray(reach[side] - (outwards[side] * places).sum(axis=1))

    def normals(self, places: FloatArray) -> FloatArray:
        """Return the directions in which the sides push at places, (n, 2)."""
        return np.asarray(-self._sides[0][self._side(places)])

    def _side(self, places: FloatArray) -> NDArray[np.intp]:
        angles = np.array([angle for angle, _ in self.profile])
        turn = np.mod(np.arctan2(places[:, 1], places[:, 0]) - angles[0], 2.0 * np.pi)
        side: NDArray[np.intp] = np.searchsorted(angles - angles[0], turn, side="right") - 1
        return side
