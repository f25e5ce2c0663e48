"""Guards of laws in their states, and the first zero of one that is a polynomial over a step."""

from dataclasses import dataclass

from ..problem import Array
from .flow import Flow, Layout

ITERATIONS = 200
LEAVES = "leaves"
"""What a reaction's guard tries."""


@dataclass(frozen=True)
class Guard:
    """A function that is positive as long as a law stays in its state."""

    law: int
    tried: str
    row: Array


def guards_of(layout: Layout, states: tuple[str, ...], flow: Flow) -> list[Guard]:
    """Return the guards of all laws, as they are documented."""
    guards = []
    for number, (law, state) in enumerate(zip(layout.laws, states, strict=True)):
        for tried, form in law.guards(state, 1.0):
            guards.append(Guard(number, tried, layout.row(number, form, flow.matrix)))
        if number in flow.reactions:
            guards.append(Guard(number, LEAVES, flow.reactions[number]))
    return guards


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
    """Look over s in [0, 1] at one that starts at zero, or below it where something jumped.

    Coefficients below ``zero`` count as none; a root at s = 0 is divided out.
    """
    if coefficients[0] < -zero:
        return Found(0.0)
    rest = coefficients[1:]
    while rest and abs(rest[0]) <= zero:
        rest = rest[1:]
    if not rest:
        return Found(None)
    return Found(0.0) if rest[0] < 0 else fall(rest)
