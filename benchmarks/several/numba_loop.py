"""A fixed-step loop: central difference compiled by numba, for any number of undamped stops."""

from time import perf_counter
from typing import Any

import numba
import numpy as np

from benchmarks.several.contacts import Contacts
from benchmarks.several.equations import Equations
from tests.reference.problem import Array
from tests.reference.several.problem import SeveralStops

STEPS_A_PERIOD = 40  # of the fastest mode


def _march(
    omega2: Array,
    damping: Array,
    rows: Array,
    gaps: Array,
    stiffness: Array,
    now: Array,
    before: Array,
    dt: float,
    below: Array,
) -> None:
    stops, modes = rows.shape
    force = np.zeros(modes)
    for n in range(below.shape[0]):
        force[:] = 0.0
        for s in range(stops):
            distance = gaps[s]
            for i in range(modes):
                distance += rows[s, i] * now[i]
            below[n, s] = distance < 0.0
            if distance < 0.0:
                for i in range(modes):
                    force[i] -= stiffness[s] * distance * rows[s, i]
        for i in range(modes):
            half = 0.5 * damping[i] * dt
            new = (2.0 - omega2[i] * dt * dt) * now[i] - (1.0 - half) * before[i]
            before[i] = now[i]
            now[i] = (new + dt * dt * force[i]) / (1.0 + half)


class NumbaLoop:
    """It knows of a contact what it sees at its steps."""

    name = f"numba central difference, {STEPS_A_PERIOD} steps a period"
    march: Any = staticmethod(numba.njit(_march))

    def find(self, problem: SeveralStops) -> Contacts:
        """March over the run."""
        equations = Equations.of(problem)
        dt = 2 * np.pi / np.sqrt(problem.omega2.max()) / STEPS_A_PERIOD
        state = np.concatenate([problem.displacement, problem.velocity])
        acceleration = equations.rates(state)[equations.modes :]
        before = problem.displacement - dt * problem.velocity + 0.5 * dt**2 * acceleration
        below = np.zeros((int(np.ceil(problem.duration / dt)), len(problem.stops)), dtype=bool)
        parts = (equations.omega2, equations.damping, equations.rows, equations.gaps)
        start = perf_counter()
        self.march(*parts, equations.stiffness, problem.displacement.copy(), before, dt, below)
        seconds = perf_counter() - start
        began = below[1:] & ~below[:-1]
        return Contacts(seconds, [list(dt * (1 + np.flatnonzero(column))) for column in began.T])
