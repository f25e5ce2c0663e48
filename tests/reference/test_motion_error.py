"""The bound on the motion's error holds, against solutions in fifty digits."""

import numpy as np
import pytest

from .precise import PreciseSolution
from .random_problems import random_problem

SAMPLES = 12


@pytest.mark.parametrize("seed", range(25))
def test_the_distance_is_as_close_as_the_bound_says(seed: int) -> None:
    # Up to the first event both start from the same numbers, so that nothing else differs.
    problem = random_problem(seed)
    events = PreciseSolution(problem).events
    first = events[0][0] if events else problem.duration
    if first == 0.0:
        pytest.skip("switches at once")
    problem = problem.but(duration=0.999 * first)
    history = problem.solve()
    times = np.linspace(0.0, problem.duration, SAMPLES)
    distance = history.law_motion(0, times)[0]
    displacement, _ = PreciseSolution(problem).motion(times)
    exact = problem.gap + displacement @ problem.row
    bound, evaluation = history.motion_error, history.missed_penetration
    assert bound is not None
    assert evaluation is not None
    assert 0.0 < bound < 1e-8 * np.abs(exact).max()
    # What is left of the comparison is the rounding of its own two sums.
    noise = 8 * np.finfo(float).eps * np.abs(displacement * problem.row).sum(axis=1).max()
    assert np.abs(distance - exact).max() <= bound + evaluation + noise
