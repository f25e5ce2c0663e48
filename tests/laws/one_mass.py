"""One free mass of 1 kg under a law, and SciPy's solution of the same in stretches."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import bumpstop as bs


def one_mass(
    *laws: Any,
    place: float = 0.0,
    speed: float = 0.0,
    duration: float = 1.0,
    loads: Sequence[Any] = (),
    frequency: float = 0.0,
) -> bs.Problem:
    """Return a mass at P that moves along x."""
    basis = bs.ModalBasis.from_modes(
        frequency=[frequency], damping=[0.0], shapes={("P", "dx"): [1.0]}
    )
    start = bs.ModalState(displacement=[place], velocity=[speed])
    return bs.Problem(basis, laws=laws, loads=loads, initial=start, duration=duration)


def shaking(size: float, frequency: float) -> bs.NodalForce:
    """Return a sine of a force on it."""
    turning = bs.Harmonic(frequency, sine=1.0)
    return bs.NodalForce("shake", node="P", force=(size, 0, 0), time=turning)


def runge_kutta(
    rates: Callable[[float, list[float]], list[float]],
    start: Sequence[float],
    duration: float,
    steps: int,
    after: Callable[[list[float]], list[float]] = lambda state: state,
) -> list[list[float]]:
    """Return the states after each of many small steps of the classical scheme of order 4."""
    h, state, states = duration / steps, list(start), [list(start)]
    for n in range(steps):
        t = n * h
        a = rates(t, state)
        b = rates(t + h / 2, [y + h / 2 * k for y, k in zip(state, a, strict=True)])
        c = rates(t + h / 2, [y + h / 2 * k for y, k in zip(state, b, strict=True)])
        d = rates(t + h, [y + h * k for y, k in zip(state, c, strict=True)])
        both = zip(state, a, b, c, d, strict=True)
        state = after([y + h / 6 * (p + 2 * q + 2 * r + s) for y, p, q, r, s in both])
        states.append(state)
    return states
