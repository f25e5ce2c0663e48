"""Shapes of wear scars: how deep a worn volume is."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from typing import Protocol

from bumpstop.arguments import not_negative, positive
from bumpstop.errors import InputError

__all__ = ["FlatScar", "HoleScar", "PadScar", "Scar"]


class Scar(Protocol):
    """The shape of a scar."""

    def depth(self, volume: float) -> float:
        """Return the largest depth in m of a worn volume in m3."""


@dataclass(frozen=True)
class PadScar:
    """A pad that wears evenly: depth = volume / area.

    Parameters
    ----------
    area
        In m2; for a ring around a tube 2 pi r times its length.
    """

    area: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "area", positive("area", self.area))

    def depth(self, volume: float) -> float:
        """Return the depth in m of a worn volume in m3."""
        return not_negative("volume", volume) / self.area


@dataclass(frozen=True)
class FlatScar:
    """A tube or rod that a plane wears flat: a segment of its circle.

    Parameters
    ----------
    radius
        Outer radius in m.
    length
        Length of the scar along the tube, in m.

    Examples
    --------
    >>> scar = FlatScar(radius=0.01, length=0.02)
    >>> half = 0.5 * 3.141592653589793 * 0.01**2 * 0.02
    >>> round(scar.depth(half), 12)
    0.01
    """

    _: KW_ONLY
    radius: float
    length: float

    def __post_init__(self) -> None:
        for key in ("radius", "length"):
            object.__setattr__(self, key, positive(key, getattr(self, key)))

    def area(self, depth: float) -> float:
        """Return the area in m2 of a segment of some depth in m."""
        return _segment(self.radius, self.radius - depth)

    def depth(self, volume: float) -> float:
        """Return the depth in m of a worn volume in m3.

        Raises
        ------
        InputError
            If the volume is more than that of the rod.
        """
        return _depth(self.area, volume, self.length, 2.0 * self.radius)


@dataclass(frozen=True)
class HoleScar:
    """A tube that wears against a wider round hole, or wears that: a crescent.

    Parameters
    ----------
    radius
        Outer radius of the tube in m.
    hole_radius
        Radius of the hole in m.
    length
        Length of the scar along the tube, in m.

    Examples
    --------
    >>> tube = HoleScar(radius=0.01, hole_radius=0.0104, length=0.02)
    >>> round(tube.depth(tube.area(1e-4) * 0.02), 12)
    0.0001
    """

    _: KW_ONLY
    radius: float
    hole_radius: float
    length: float

    def __post_init__(self) -> None:
        for key in ("radius", "hole_radius", "length"):
            object.__setattr__(self, key, positive(key, getattr(self, key)))
        if self.hole_radius <= self.radius:
            what = f"must be more than the tube's, {self.radius:g} m"
            raise InputError(what, key="hole_radius", value=self.hole_radius)

    def area(self, depth: float) -> float:
        """Return the area in m2 of the tube's circle that some depth in m is beyond the hole's."""
        r, hole = self.radius, self.hole_radius
        apart = hole - r + depth
        if apart <= hole - r:
            return 0.0
        # The circles meet in a chord at this distance from the middle of the tube, towards the
        # middle of the hole negative.
        chord = (hole**2 - r**2 - apart**2) / (2.0 * apart)
        return _segment(r, chord) - _segment(hole, chord + apart)

    def depth(self, volume: float) -> float:
        """Return the depth in m of a worn volume in m3.

        Raises
        ------
        InputError
            If the volume is more than that of the tube.
        """
        return _depth(self.area, volume, self.length, 2.0 * self.radius)


def _segment(radius: float, distance: float) -> float:
    """Return the area of a circle beyond a chord at a distance from its middle."""
    cosine = min(max(distance / radius, -1.0), 1.0)
    # Half the angle of the chord, without the cancellation of acos near 1.
    angle = 2.0 * math.asin(math.sqrt(0.5 * (1.0 - cosine)))
    if angle < 1e-2:
        # 2 a - sin 2 a by its series, whose difference would cancel.
        double = 2.0 * angle
        return 0.5 * radius**2 * double**3 / 6.0 * (1.0 - double**2 / 20.0 + double**4 / 840.0)
    return radius**2 * (angle - math.sin(angle) * math.cos(angle))


def _depth(area: Callable[[float], float], volume: float, length: float, most: float) -> float:
    """Return the depth at which a scar of a length has a volume: areas grow with depths."""
    from scipy.optimize import brentq

    wanted = not_negative("volume", volume) / length
    if wanted == 0.0:
        return 0.0
    if wanted > area(most):
        what = "is more than there is to be worn"
        hint = f"that is {area(most) * length:.6g} m3"
        raise InputError(what, key="volume", value=volume, hint=hint)
    found: float = brentq(lambda depth: area(depth) - wanted, 0.0, most, xtol=1e-15, rtol=1e-14)
    return found
