"""Guards of stops in their states, and the first zero of one that is a polynomial over a step."""

from dataclasses import dataclass

from ..problem import CLOSED, OPEN, RELEASED, Array
from .flow import distance_row, rate_row
from .loads import Exosystem
from .problem import Stop

ITERATIONS = 200


@dataclass(frozen=True)
class Guard:
    """A function that is positive as long as a stop stays in its state."""

    stop: int
    after: str
    row: Array


def guards_of(number: int, stop: Stop, state: str, exosystem: Exosystem) -> list[Guard]:
    """Return the guards of one stop, as the law is documented."""
    distance = distance_row(stop, exosystem)
    push = -distance - stop.damping / stop.stiffness * rate_row(stop, exosystem)
    if state == OPEN:
        return [Guard(number, CLOSED, distance)]
    if state == CLOSED:
        return [Guard(number, RELEASED if stop.damping > 0 else OPEN, push)]
    return [Guard(number, OPEN, -distance), Guard(number, CLOSED, -push)]


def horner(coefficients: list[float], s: float) -> tuple[float, float]:
    """Return a polynomial and its derivative."""
    value = slope = 0.0
    for a in reversed(coefficients):
        slope = slope * s + value
        value = value * s + a
    return value, slope


def derivative(coefficients: list[float]) -> list[float]:
    """Return the coefficients of the derivative."""
    return [n * a for n, a in enumerate(coefficients)][1:]


def root(coefficients: list[float], left: float, right: float) -> float:
    """Newton's method inside a bracket over which the polynomial changes its sign."""
    rising = horner(coefficients, right)[0] > 0
    s = 0.5 * (left + right)
    for _ in range(ITERATIONS):
        value, slope = horner(coefficients, s)
        if value == 0.0:
            return s
        left, right = (left, s) if (value > 0) == rising else (s, right)
        new = s - value / slope if slope != 0.0 else left
        if not left < new < right:
            new = 0.5 * (left + right)
        if abs(new - s) <= 1e-16 * abs(new) or new == s:
            return new
        s = new
    return s


@dataclass(frozen=True)
class Found:
    """What a polynomial does over a step: where it falls below zero, and its minimum."""

    at: float | None
    lowest: float | None = None


def fall(coefficients: list[float]) -> Found:
    """Look over s in [0, 1] at a polynomial that is positive at s = 0."""
    slopes = derivative(coefficients)
    end = horner(coefficients, 1.0)[0]
    if slopes[0] < 0 < horner(slopes, 1.0)[0]:
        bottom = root(slopes, 0.0, 1.0)
        lowest = horner(coefficients, bottom)[0]
        if lowest <= 0:
            return Found(root(coefficients, 0.0, bottom), lowest)
        return Found(root(coefficients, bottom, 1.0) if end <= 0 else None, lowest)
    return Found(root(coefficients, 0.0, 1.0) if end <= 0 else None)


def departure(coefficients: list[float], zero: float) -> Found:
    """Look over s in [0, 1] at one that is zero at s = 0: divide that root out.

    Coefficients below ``zero`` count as none.
    """
    rest = coefficients[1:]
    while rest and abs(rest[0]) <= zero:
        rest = rest[1:]
    if not rest:
        return Found(None)
    return Found(0.0) if rest[0] < 0 else fall(rest)
