"""A spring whose stiffness swings: a mass of 1 kg on it obeys Mathieu's equation."""

from math import cos

CHARACTERISTIC = 4.3713009827350857
"""The number a of the even solution of period pi, ce_2, for Q."""
Q = 1.0


def force(q: float, v: float, t: float) -> float:  # noqa: ARG001  # all laws are told their speed
    """Return the force on the mass, in N."""
    return -(CHARACTERISTIC - 2.0 * Q * cos(2.0 * t)) * q
