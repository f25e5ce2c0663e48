"""The bound on the motion's error holds, against solutions in fifty digits."""

from itertools import pairwise

import numpy as np
import pytest
from mpmath import mp

from .precise import PreciseSolution
from .problem import Array
from .random_problems import random_problem
from .several.laws.friction_stop import FrictionStop
from .several.laws.stop import Stop
from .several.loads import Table
from .several.precise import PreciseSeveral
from .several.problem import SeveralStops
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


def under_straight_lines(omega2: float, damping: float, width: float, values: Array) -> Array:
    """Return an oscillator's positions at the knots of its force, in forty digits, from rest."""
    with mp.workdps(40):
        c, w2, h = mp.mpf(damping) / 2, mp.mpf(omega2), mp.mpf(width)
        w = mp.sqrt(w2 - c * c)
        decay, cos, sin = mp.exp(-c * h), mp.cos(w * h), mp.sin(w * h)
        x, v, path = mp.mpf(0), mp.mpf(0), [0.0]
        for start, end in pairwise(map(mp.mpf, values.tolist())):
            slope = (end - start) / h
            # It follows the force at a distance: y = x - (a + b t).
            b = slope / w2
            a = (start - 2 * c * b) / w2
            y, u = x - a, v - b
            turned = (u + c * y) / w
            x = decay * (y * cos + turned * sin) + a + b * h
            v = decay * (u * cos - (c * turned + w * y) * sin) + b
            path.append(float(x))
    return np.array(path)


@pytest.mark.parametrize("frequency", [1.0, 30.0])
def test_errors_go_on_over_the_knots_of_a_table(frequency: float) -> None:
    # A bound of each straight line by itself is exceeded some hundred times here.
    width, knots = 2.0**-10, 3001
    omega2, damping = float((2 * np.pi * frequency) ** 2), 0.01 * frequency
    values = np.random.default_rng(4).normal(size=knots)
    times: Array = width * np.arange(knots, dtype=float)
    problem = SeveralStops(
        omega2=np.array([omega2]),
        damping=np.array([damping]),
        stops=(Stop(np.ones(1), 1e3, 1e3),),
        duration=width * (knots - 1),
        displacement=np.zeros(1),
        velocity=np.zeros(1),
        loads=(Table(np.ones(1), times, values),),
    )
    history = problem.solve()
    exact = under_straight_lines(omega2, damping, width, values)
    found = history.project(np.ones(1), times, 0)
    bound = history.motion_error
    assert bound is not None
    noise = 8 * np.finfo(float).eps * np.abs(exact).max()
    assert np.abs(found - exact).max() <= bound + noise
    assert bound < 1e-8 * np.abs(exact).max()


WEIGHT, SLIDING, DRAG = 10.0, 0.3, 0.1


def sliding(stiffness: float, start: Array, velocity: Array, time: float) -> Array:
    """Return a block on a spring of 100 N/m and its height on a floor, in forty digits."""
    with mp.workdps(40):
        c, k, weight, t = mp.mpf(DRAG), mp.mpf(stiffness), mp.mpf(WEIGHT), mp.mpf(time)
        turn = mp.sqrt(k)
        # Height and its rate make one turning number; N = weight - k re(sink exp(i turn t)).
        sink = mp.mpc(mp.mpf(float(start[1])) + weight / k, -mp.mpf(float(velocity[1])) / turn)
        # x'' + c x' + 100 x = -mu N
        steady = -mp.mpf(SLIDING) * weight / 100
        rub = mp.mpf(SLIDING) * k * sink / (100 - k + 1j * c * turn)
        half = c / 2
        w = mp.sqrt(100 - half * half)
        x0 = mp.mpf(float(start[0])) - steady - mp.re(rub)
        v0 = mp.mpf(float(velocity[0])) - mp.re(1j * turn * rub)
        free = mp.exp(-half * t) * (x0 * mp.cos(w * t) + (v0 + half * x0) / w * mp.sin(w * t))
        turned = mp.expj(turn * t)
        place = free + steady + mp.re(rub * turned)
        return np.array([float(place), float(mp.re(sink * turned) - weight / k)])


@pytest.mark.parametrize(("stiffness", "limit"), [(1e6, 1e-11), (1e8, 1e-9)])
def test_a_long_slide_on_a_stiff_floor_has_a_bound_that_says_something(
    stiffness: float, limit: float
) -> None:
    floor = Stop(np.array([0.0, 1.0]), 0.0, stiffness)
    rough = FrictionStop(floor, np.array([1.0, 0.0]), SLIDING, SLIDING, 0.5 * stiffness)
    problem = SeveralStops(
        omega2=np.array([100.0, 0.0]),
        damping=np.array([DRAG, 0.0]),
        stops=(),
        others=(rough,),
        duration=0.13,
        displacement=np.array([0.0, -1.01 * WEIGHT / stiffness]),
        velocity=np.array([5.0, 0.0]),
        force=np.array([0.0, -WEIGHT]),
    )
    history = problem.solve()
    slips = float(np.array(history.events()["time"]).item())
    start, velocity = (history.motion(np.array([slips]), order)[0] for order in (0, 1))
    times = np.linspace(slips, problem.duration, SAMPLES)
    wanted = np.array([sliding(stiffness, start, velocity, t - slips) for t in times])
    bound = history.motion_error
    assert bound is not None
    # What is left of the comparison is the rounding of times, which the floor's turns feel.
    noise = 8 * np.finfo(float).eps * np.abs(wanted).max()
    assert np.abs(history.motion(times, 0) - wanted).max() <= bound + noise
    assert bound < limit


def test_without_laws_the_bound_is_that_of_the_modal_coordinates() -> None:
    omega2 = np.array([3.0])
    free = SeveralStops(
        omega2=omega2,
        damping=np.zeros(1),
        stops=(),
        duration=50.0 / float(np.sqrt(omega2[0])),
        displacement=np.ones(1),
        velocity=np.zeros(1),
    )
    history = free.solve()
    times = np.linspace(0.0, free.duration, SAMPLES)
    with mp.workdps(40):
        exact = [float(mp.cos(mp.sqrt(mp.mpf(float(omega2[0]))) * mp.mpf(t))) for t in times]
    bound = history.motion_error
    assert bound is not None
    assert 0.0 < bound < 1e-12
    assert np.abs(history.motion(times, 0)[:, 0] - exact).max() <= bound + np.finfo(float).eps
