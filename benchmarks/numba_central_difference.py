"""The loop that a Python user writes for speed: central difference, compiled by numba.

Local arrays, one pass over the modes a step, the stop force from the step before; it keeps the
tip at the outputs only.
"""

from collections.abc import Callable
from time import perf_counter

import numba
import numpy as np

from benchmarks.solver import Run
from tests.reference.problem import Array, StopProblem


def _march(
    omega2: Array,
    damping: Array,
    row: Array,
    velocity: Array,
    stiffness: float,
    dt: float,
    every: int,
    tip: Array,
) -> None:
    modes = omega2.size
    own, past, gain = np.empty(modes), np.empty(modes), np.empty(modes)
    q, before, phi = np.zeros(modes), np.empty(modes), row.copy()
    for i in range(modes):
        half = 0.5 * damping[i] * dt
        own[i] = (2.0 - omega2[i] * dt * dt) / (1.0 + half)
        past[i] = -(1.0 - half) / (1.0 + half)
        gain[i] = dt * dt * row[i] / (1.0 + half)
        before[i] = -dt * velocity[i] * (1.0 + half)
    distance = 0.0
    for n in range(tip.size * every):
        force = -stiffness * distance if distance < 0.0 else 0.0
        distance = 0.0
        for i in range(modes):
            new = own[i] * q[i] + past[i] * before[i] + gain[i] * force
            before[i] = q[i]
            q[i] = new
            distance += phi[i] * new
        if (n + 1) % every == 0:
            tip[n // every] = distance


class NumbaCentralDifference:
    """The loop above for a beam that starts on a stop without gap or damper, at its velocity."""

    def __init__(self, dt: float, fastmath: bool) -> None:
        self.dt = dt
        self.name = f"numba central difference, dt = {dt:.0e} s{', fastmath' * fastmath}"
        self.march: Callable[..., None] = numba.njit(fastmath=fastmath)(_march)

    def solve(self, problem: StopProblem, times: Array) -> Run:
        """March over equally spaced outputs."""
        tip = np.empty(times.size)
        every = round(times[0] / self.dt)
        start = perf_counter()
        self.march(
            problem.omega2,
            problem.damping,
            problem.row,
            problem.velocity,
            problem.stiffness,
            self.dt,
            every,
            tip,
        )
        return Run(perf_counter() - start, tip)
