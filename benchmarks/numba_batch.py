"""The loops that a Python user writes for many problems: central difference, compiled by numba.

One runs over the problems on all cores; the other carries eight problems side by side through
each step, so that the compiler puts them into the vector registers.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba
import numpy as np

from tests.reference.problem import Array

LANES = 8


def _loop(
    omega2: Array,
    damping: Array,
    row: Array,
    velocity: Array,
    stiffness: Array,
    gap: Array,
    scale: Array,
    dt: float,
    every: Array,
    tips: Array,
) -> None:
    """March every problem by itself."""
    modes = omega2.size
    half = 0.5 * damping * dt
    for run in numba.prange(stiffness.size):
        own, past, gain = np.empty(modes), np.empty(modes), np.empty(modes)
        q, before = np.zeros(modes), np.empty(modes)
        for i in range(modes):
            own[i] = (2.0 - omega2[i] * dt * dt) / (1.0 + half[i])
            past[i] = -(1.0 - half[i]) / (1.0 + half[i])
            gain[i] = dt * dt * row[i] / (1.0 + half[i])
            before[i] = -dt * scale[run] * velocity[i] * (1.0 + half[i])
        k, distance, kept = stiffness[run], gap[run], 0
        for n in range(every[-1]):
            force = -k * distance if distance < 0.0 else 0.0
            distance = gap[run]
            for i in range(modes):
                new = own[i] * q[i] + past[i] * before[i] + gain[i] * force
                before[i] = q[i]
                q[i] = new
                distance += row[i] * new
            if n + 1 == every[kept]:
                tips[run, kept] = distance - gap[run]
                kept += 1


def _consecutive(x: Array, n: int) -> tuple[float, ...]:
    """Return eight numbers."""
    return x[n], x[n + 1], x[n + 2], x[n + 3], x[n + 4], x[n + 5], x[n + 6], x[n + 7]


_each: Any = numba.njit(inline="always")(_consecutive)


def _eight(
    omega2: Array,
    damping: Array,
    row: Array,
    velocity: Array,
    stiffness: Array,
    gap: Array,
    scale: Array,
    dt: float,
    every: Array,
    tips: Array,
) -> None:
    """March eight problems side by side, written out: loops over lanes are half as fast."""
    modes = omega2.size
    half = 0.5 * damping * dt
    own = (2.0 - omega2 * dt * dt) / (1.0 + half)
    past = -(1.0 - half) / (1.0 + half)
    gain = dt * dt * row / (1.0 + half)
    for group in numba.prange(stiffness.size // LANES):
        first = group * LANES
        q, before = np.zeros((modes, LANES)), np.empty((modes, LANES))
        for i in range(modes):
            for lane in range(LANES):
                before[i, lane] = -dt * scale[first + lane] * velocity[i] * (1.0 + half[i])
        k0, k1, k2, k3, k4, k5, k6, k7 = _each(stiffness, first)
        r0, r1, r2, r3, r4, r5, r6, r7 = _each(gap, first)
        d0, d1, d2, d3, d4, d5, d6, d7 = r0, r1, r2, r3, r4, r5, r6, r7
        kept = 0
        for n in range(every[-1]):
            f0 = max(0.0, -k0 * d0)
            f1 = max(0.0, -k1 * d1)
            f2 = max(0.0, -k2 * d2)
            f3 = max(0.0, -k3 * d3)
            f4 = max(0.0, -k4 * d4)
            f5 = max(0.0, -k5 * d5)
            f6 = max(0.0, -k6 * d6)
            f7 = max(0.0, -k7 * d7)
            d0, d1, d2, d3, d4, d5, d6, d7 = r0, r1, r2, r3, r4, r5, r6, r7
            for i in range(modes):
                a, b, c, phi = own[i], past[i], gain[i], row[i]
                x0, x1, x2, x3, x4, x5, x6, x7 = _each(q[i], 0)
                n0 = a * x0 + b * before[i, 0] + c * f0
                n1 = a * x1 + b * before[i, 1] + c * f1
                n2 = a * x2 + b * before[i, 2] + c * f2
                n3 = a * x3 + b * before[i, 3] + c * f3
                n4 = a * x4 + b * before[i, 4] + c * f4
                n5 = a * x5 + b * before[i, 5] + c * f5
                n6 = a * x6 + b * before[i, 6] + c * f6
                n7 = a * x7 + b * before[i, 7] + c * f7
                before[i, 0] = x0
                before[i, 1] = x1
                before[i, 2] = x2
                before[i, 3] = x3
                before[i, 4] = x4
                before[i, 5] = x5
                before[i, 6] = x6
                before[i, 7] = x7
                q[i, 0] = n0
                q[i, 1] = n1
                q[i, 2] = n2
                q[i, 3] = n3
                q[i, 4] = n4
                q[i, 5] = n5
                q[i, 6] = n6
                q[i, 7] = n7
                d0 += phi * n0
                d1 += phi * n1
                d2 += phi * n2
                d3 += phi * n3
                d4 += phi * n4
                d5 += phi * n5
                d6 += phi * n6
                d7 += phi * n7
            if n + 1 == every[kept]:
                tips[first + 0, kept] = d0 - r0
                tips[first + 1, kept] = d1 - r1
                tips[first + 2, kept] = d2 - r2
                tips[first + 3, kept] = d3 - r3
                tips[first + 4, kept] = d4 - r4
                tips[first + 5, kept] = d5 - r5
                tips[first + 6, kept] = d6 - r6
                tips[first + 7, kept] = d7 - r7
                kept += 1


Marcher = Callable[..., None]


def loop() -> Marcher:
    """Return the loop over problems, on all cores."""
    compiled: Marcher = numba.njit(parallel=True, fastmath=True)(_loop)
    return compiled


def eight_lanes() -> Marcher:
    """Return the loop over groups of eight, on all cores."""
    compiled: Marcher = numba.njit(parallel=True, fastmath=True)(_eight)
    return compiled
