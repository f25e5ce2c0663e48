"""Seeded random problems in which one stop is touched only just, or only just not."""

from dataclasses import replace

import numpy as np

from ..problem import Array
from .problem import SeveralStops
from .random_problems import random_several
from .scan import ScanSolution

LARGEST_GROWTH = 1e4
SAMPLES = 4000
SHALLOWEST, DEEPEST = -8.0, -3.0  # powers of ten of the largest excursion


def random_grazing(seed: int) -> SeveralStops:
    """Return the random problem of this seed, its last stop where the motion turns back."""
    problem = random_several(seed)
    rng = np.random.default_rng([seed, 3])
    *others, stop = problem.stops
    without = problem.but(stops=tuple(others))
    solution = ScanSolution(without, LARGEST_GROWTH)
    times = np.linspace(0.0, solution.end, SAMPLES)
    displacement, velocity = solution.motion(times)
    path, rate = displacement @ stop.row, velocity @ stop.row
    turns = np.flatnonzero((rate[:-1] < 0) & (rate[1:] > 0))
    lowest = path[0] if turns.size == 0 else np.inf
    if turns.size:
        at = int(turns[np.argmin(path[turns])])
        lowest = turning_point(solution, stop.row, times[at], times[at + 1])
    reach = float(np.abs(path).max()) or 1.0
    depth = float(rng.choice([-1.0, 1.0])) * reach * 10 ** float(rng.uniform(SHALLOWEST, DEEPEST))
    grazed = replace(stop, gap=float(-lowest - depth))
    return problem.but(stops=(*others, grazed), duration=solution.end)


def turning_point(solution: ScanSolution, row: Array, left: float, right: float) -> float:
    """Return the least of ``row . q`` between two instants, by bisecting its rate."""
    for _ in range(40):
        middle = (left + right) / 2
        displacement, velocity = solution.motion(np.array([middle]))
        left, right = (left, middle) if velocity[0] @ row > 0 else (middle, right)
    return float(displacement[0] @ row)
