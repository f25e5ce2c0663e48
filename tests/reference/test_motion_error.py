"""The bound on the motion's error holds, against solutions in fifty digits."""

import numpy as np
import pytest

from .precise import PreciseSolution
from .random_problems import random_problem
from .several.precise import PreciseSeveral
from .several.rigid import random_rigid
from .several.verdict import LARGEST_GROWTH

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


@pytest.mark.parametrize("seed", [1, 3, 6, 7, 8, 10, 11, 12, 13, 14, 19, 23])
def test_before_rigid_stops_are_met_the_motion_is_as_close_as_the_bound_says(seed: int) -> None:
    problem = random_rigid(seed)
    events = PreciseSeveral(problem, 1, LARGEST_GROWTH).events
    first = min((event.time for event in events), default=problem.duration)
    problem = problem.but(duration=0.999 * first)
    history = problem.solve()
    times = np.linspace(0.0, problem.duration, SAMPLES)
    displacement = PreciseSeveral(problem, 1, LARGEST_GROWTH).motion(times)[0]
    bound, evaluation = history.motion_error, history.missed_penetration
    assert bound is not None
    assert evaluation is not None
    for number, law in enumerate(problem.laws):
        row, gap = law.coordinates[0]
        exact = gap + displacement @ row
        apart = np.abs(history.law_motion(number, times)[0] - exact).max()
        noise = 8 * np.finfo(float).eps * np.abs(displacement * row).sum(axis=1).max()
        assert apart <= bound + evaluation + noise


@pytest.mark.parametrize("seed", [0, 2, 4, 9, 15, 17, 26, 41])
def test_impacts_and_rest_leave_no_gap_in_the_motion(seed: int) -> None:
    # A stop that is passed unseen puts the motion back by a jump, which the bound must not have.
    problem = random_rigid(seed)
    history = problem.solve()
    bound = history.motion_error
    assert bound is not None
    times = np.linspace(0.0, problem.duration, SAMPLES)
    reach = max(np.abs(history.law_motion(n, times)[0]).max() for n in range(len(problem.laws)))
    assert 0.0 < bound < 1e-8 * reach
