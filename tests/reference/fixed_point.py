"""What a straight-line load does to a linear structure, by a recurrence in whole numbers.

Over one step the load is a straight line, and the motion a product of the exponential of a matrix,
made by mpmath with fifty digits. The products are of whole numbers, multiples of ``2**-BITS``:
nothing is lost over any number of steps, and Python takes a hundred thousand of them in a second.
"""

from collections.abc import Sequence
from fractions import Fraction

import numpy as np
from mpmath import mp, mpf

from .problem import Array

BITS = 160
DIGITS = 50


def whole(x: float | mpf) -> int:
    """Return a number in units of ``2**-BITS``."""
    if isinstance(x, float):
        return int(Fraction(x) * 2**BITS)
    return int(mp.nint(x * mpf(2) ** BITS))


def states(
    stiffness: Array,
    damping: Array,
    load: tuple[Array, Array],
    values: Sequence[float] | Array,
    steps_a_second: int,
) -> Array:
    """Return ``(q, q')`` at each knot, from rest, one row a knot.

    ``q'' + C q' + K q = a f + b f'`` with f straight between values, ``load`` being (a, b).
    """
    count = len(stiffness)
    with mp.workdps(DIGITS):
        matrix = mp.zeros(2 * count + 2)
        for i in range(count):
            matrix[i, count + i] = 1
            matrix[count + i, 2 * count] = mpf(float(load[0][i]))
            matrix[count + i, 2 * count + 1] = mpf(float(load[1][i]))
            for k in range(count):
                matrix[count + i, k] = -mpf(float(stiffness[i, k]))
                matrix[count + i, count + k] = -mpf(float(damping[i, k]))
        matrix[2 * count, 2 * count + 1] = 1
        flow = mp.expm(matrix / steps_a_second)
        rows = [[whole(flow[i, k]) for k in range(2 * count + 2)] for i in range(2 * count)]
    knots = [whole(float(value)) for value in values]
    state = [0] * (2 * count)
    found = np.zeros((len(knots), 2 * count))
    for n in range(len(knots) - 1):
        slope = (knots[n + 1] - knots[n]) * steps_a_second
        held = (*state, knots[n], slope)
        state = [sum(a * b for a, b in zip(row, held, strict=True)) >> BITS for row in rows]
        found[n + 1] = [x / 2**BITS for x in state]
    return found
