"""What is to be said of the modes of a basis, in a line each."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from bumpstop.arguments import FloatArray

__all__ = ["feeding_told", "rigid_told", "unstable_told"]

_ROUNDING = 1e-9
"""A damping this small beside the largest of its matrix is rounding."""


def rigid_told(motions: Sequence[str], longest: int = 6) -> list[str]:
    """Return a line that names the first motions which strain nothing, where there are any.

    Examples
    --------
    >>> rigid_told(["translation along z"])
    ['1 rigid mode: translation along z']
    >>> rigid_told(["a", "b", "c"], longest=2)
    ['3 rigid modes: a; b; and 1 more']
    """
    if not motions:
        return []
    number = "1 rigid mode" if len(motions) == 1 else f"{len(motions)} rigid modes"
    more = f"; and {len(motions) - longest} more" if len(motions) > longest else ""
    return [f"{number}: {'; '.join(motions[:longest])}{more}"]


def unstable_told(omega2: FloatArray) -> list[str]:
    """Return a line that tells in which modes the structure moves away by itself, if in any.

    Examples
    --------
    >>> unstable_told(np.array([-4.0, 0.0, 9.0]))
    ['the structure is unstable in mode 1: it moves away by itself']
    >>> unstable_told(np.array([-4.0, -1.0]))
    ['the structure is unstable in all its 2 modes: is the sign of the stiffness right?']
    """
    numbers = np.flatnonzero(omega2 < 0.0) + 1
    if len(numbers) == 0:
        return []
    if len(numbers) == len(omega2) > 1:
        which = f"all its {len(numbers)} modes: is the sign of the stiffness right?"
    elif len(numbers) == 1:
        which = f"mode {numbers[0]}: it moves away by itself"
    elif numbers[-1] - numbers[0] == len(numbers) - 1:
        which = f"modes {numbers[0]} to {numbers[-1]}: it moves away by itself"
    else:
        which = f"{len(numbers)} modes, {numbers[0]} the first: it moves away by itself"
    return [f"the structure is unstable in {which}"]


def feeding_told(damping: FloatArray | None) -> list[str]:
    """Return a line that says so where a damping matrix adds energy to some motion.

    Examples
    --------
    >>> feeding_told(np.diag([0.2, -0.1]))
    ['negative damping feeds energy into the modes']
    """
    if damping is None or not damping.any():
        return []
    least = np.linalg.eigvalsh(damping)[0]
    if least >= -_ROUNDING * np.abs(damping).max():
        return []
    return ["negative damping feeds energy into the modes"]
