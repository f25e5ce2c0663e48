"""How steeply the force of a law may rise, and along which coordinates."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from bumpstop.laws.coordinate import Coordinate

if TYPE_CHECKING:
    from bumpstop.problem import Law

__all__ = ["pressed_coordinates", "steepness"]


def pressed_coordinates(law: Law) -> tuple[Coordinate, ...]:
    """Return the coordinates that a law pushes along: both across the axis of an obstacle."""
    across: Sequence[Coordinate] = getattr(law, "coordinates", ())
    return tuple(across[:2]) if hasattr(law, "axis") else (law.coordinate,)


def steepness(law: Law, energy: float) -> float:
    """Return the largest slope in N/m of a law's force, as far as it is known; else zero.

    The slope of a power grows with the depth: that is taken at which the stop alone would hold
    an energy in J. Laws that are functions in Python, and rigid stops, have none that is known.

    Examples
    --------
    >>> import bumpstop as bs
    >>> ball = bs.HertzStop("ball", node="P", normal=(1, 0, 0), stiffness=1e9)
    >>> depth = (2.5 * 0.5 / 1e9) ** 0.4
    >>> f"{steepness(ball, 0.5) / (1.5 * 1e9 * depth**0.5):.9f}"
    '1.000000000'
    """
    own: float | None = getattr(law, "steepest", None)
    if own is not None:
        return own
    stiffness: object = getattr(law, "stiffness", None)
    if not isinstance(stiffness, float):
        return 0.0
    exponent: float | None = getattr(law, "exponent", None)
    if exponent is None:
        return stiffness
    depth = ((exponent + 1.0) * energy / stiffness) ** (1.0 / (exponent + 1.0))
    return float(exponent * stiffness * depth ** (exponent - 1.0))
