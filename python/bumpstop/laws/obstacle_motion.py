"""How obstacles of a shape move: along the global axes, over time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.errors import InputError
from bumpstop.projection import TRANSLATIONS

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.loads.time import TimeFunction

__all__ = ["along_axes", "along_directions", "moved"]


def along_axes(value: object) -> dict[str, tuple[TimeFunction, ...]]:
    """Return the functions of time whose sums move an obstacle along the global axes.

    Raises
    ------
    InputError
        If it is no mapping from dx, dy and dz to functions of time.
    """
    from bumpstop.loads.time import time_functions

    if not isinstance(value, Mapping) or not value or set(value) - set(TRANSLATIONS):
        what = f"must say for some of {', '.join(TRANSLATIONS)} how the obstacle moves along them"
        hint = 'such as {"dy": Harmonic(5.0, sine=1e-3)}'
        raise InputError(what, key="motion", value=value, hint=hint)
    return {
        dof: time_functions(value[dof], f"motion.{dof}") for dof in TRANSLATIONS if dof in value
    }


def along_directions(
    motion: Mapping[str, Sequence[TimeFunction]], directions: FloatArray
) -> tuple[tuple[TimeFunction, ...], ...]:
    """Return the functions whose sums move an obstacle along each of some unit vectors, (n, 3)."""
    from bumpstop.loads.time import scaled

    parts = [(TRANSLATIONS.index(dof), functions) for dof, functions in motion.items()]
    return tuple(
        tuple(
            scaled(function, float(direction[axis]))
            for axis, functions in parts
            if direction[axis] != 0.0
            for function in functions
        )
        for direction in directions
    )


def moved(
    motion: Mapping[str, Sequence[TimeFunction]],
    duration: float,
    times: FloatArray,
    derivative: int,
) -> FloatArray:
    """Return how far an obstacle has moved along the global axes, or how fast, (time, 3).

    Parameters
    ----------
    motion
        The functions along some axes.
    duration
        How long the run is, in s.
    times
        In s, (time,).
    derivative
        0 for how far, in m, 1 for how fast, in m/s.
    """
    from bumpstop.loads.time import resolved
    from bumpstop.loads.travel import rate

    total = np.zeros((len(times), len(TRANSLATIONS)))
    for dof, functions in motion.items():
        for term in resolved(functions, duration):
            followed = rate(term) if derivative else term
            total[:, TRANSLATIONS.index(dof)] += followed.at(times)
    return total
