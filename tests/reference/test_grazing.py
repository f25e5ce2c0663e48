"""Touching without crossing: exactly, by a little on either side, flatly, and while others push.

A touch missed by the depth e costs an impulse of ``4/3 k e sqrt(2 e / d'')``: where the instant
cannot be told, the motion after it still can.
"""

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.optimize import brentq

from .one_mass import DIGITS, Curve, Mass, OneMass, Wall
from .problem import CLOSED, RELEASED
from .several.agreement import agreement
from .several.precise import PreciseSeveral
from .several.problem import SeveralStops, Stop
from .several.random_problems import random_several
from .several.scan import ScanSolution
from .several.verdict import compare

EXACT = 1e-11
DEPTHS = [0.0, *(sign * depth for depth in (1e-9, 1e-12, 1e-15) for sign in (1, -1))]
TELLABLE = 1e-12  # a depth that rounding does not hide

# (1 + cos t)^n as a sum of cosines: zero with its first 2n - 1 derivatives at odd multiples of pi.
FLAT = {
    2: (1.0, [1.0]),
    4: (1.5, [2.0, 0.5]),
    6: (2.5, [3.75, 1.5, 0.25]),
}


def cosines(order: int, stiffness: float, start: str) -> SeveralStops:
    """Return modes whose free vibration touches a stop to an order, from afar or touching."""
    gap, amplitudes = FLAT[order]
    rates = np.arange(1.0, len(amplitudes) + 1)
    sign = 1.0 if start == "afar" else (-1.0) ** rates
    return SeveralStops(
        omega2=rates**2,
        damping=0 * rates,
        stops=(Stop(np.ones(rates.size), gap, stiffness),),
        duration=40.0,
        displacement=sign * np.array(amplitudes),
        velocity=0 * rates,
    )


@pytest.mark.parametrize("order", FLAT)
@pytest.mark.parametrize("stiffness", [1.0, 1e4, 1e8])
@pytest.mark.parametrize("start", ["afar", "touching"])
def test_an_exact_touch_changes_nothing(order: int, stiffness: float, start: str) -> None:
    problem = cosines(order, stiffness, start)
    times = np.linspace(0.0, problem.duration, 101)
    history = problem.solve()
    phases = np.outer(times, np.sqrt(problem.omega2))
    free = problem.displacement * np.cos(phases)
    assert history.motion(times, 0) == pytest.approx(free, abs=EXACT)
    rates = -problem.displacement * np.sqrt(problem.omega2) * np.sin(phases)
    assert history.motion(times, 1) == pytest.approx(rates, abs=EXACT)


def swing(depth: float, stiffness: float, damping: float = 0.0) -> Mass:
    """Return a swing of unit amplitude that goes into two walls, each by a depth."""
    walls = tuple(Wall(side, 1.0 - depth, stiffness, damping) for side in (1, -1))
    return Mass(walls, duration=20.0, velocity=1.0, omega2=1.0)


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("stiffness", [1.0, 1e4, 1e8])
@pytest.mark.parametrize("damping", [0.0, 1.0])
def test_a_swing_just_reaches_two_walls(depth: float, stiffness: float, damping: float) -> None:
    mass = swing(depth, stiffness, damping)
    oracle = OneMass(mass)
    assert bool(oracle.events) == (depth > 0)
    result = agreement(mass.several(), oracle)
    assert result.state_error < EXACT
    assert result.energy_residual < EXACT
    if abs(depth) >= TELLABLE:
        assert result.same_events


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("stiffness", [1.0, 1e4, 1e8])
def test_a_thrown_mass_just_reaches_a_wall(depth: float, stiffness: float) -> None:
    mass = Mass((Wall(1, 1.0 - depth, stiffness),), 3.0, velocity=-2.0, force=2.0)
    result = agreement(mass.several(), oracle := OneMass(mass))
    assert bool(oracle.events) == (depth > 0)
    assert result.state_error < EXACT
    if abs(depth) >= TELLABLE:
        assert result.same_events


@pytest.mark.parametrize("depth", DEPTHS)
def test_a_force_just_vanishes(depth: float) -> None:
    # Twice the static displacement: the mass comes up to the height at which it would let go.
    start = -0.5 - 0.25 * depth
    mass = Mass((Wall(1, 0.0, 400.0),), 2.0, displacement=start, force=-100.0)
    result = agreement(mass.several(), oracle := OneMass(mass))
    assert bool(oracle.events) == (depth > 0)
    assert result.state_error < EXACT
    if abs(depth) >= TELLABLE:
        assert result.same_events


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("stiffness", [1.0, 1e4, 1e8])
def test_a_second_wall_is_just_reached_while_the_first_one_pushes(
    depth: float, stiffness: float
) -> None:
    # Laid down on the first wall the mass swings down to 0.5 below it, where the second one is.
    walls = (Wall(1, 0.0, 400.0), Wall(1, 0.5 - depth, stiffness))
    mass = Mass(walls, duration=2.0, force=-100.0)
    result = agreement(mass.several(), oracle := OneMass(mass))
    assert any(event.stop == 1 for event in oracle.events) == (depth > 0)
    assert result.state_error < EXACT
    if abs(depth) >= TELLABLE:
        assert result.same_events


def test_touches_of_three_walls_meet() -> None:
    # One begins to push at no speed, one is left and one reached at no speed, again and again.
    walls = (Wall(1, 0.25, 400.0), Wall(-1, -0.25, 100.0), Wall(1, 0.75, 77.0))
    mass = Mass(walls, duration=3.0, displacement=-0.25, force=-100.0)
    oracle = OneMass(mass)
    assert not oracle.events
    assert agreement(mass.several(), oracle).state_error < EXACT


def let_go(depth: float) -> Mass:
    """Return a mass let go on a damped wall, whose force dips to zero on its way up."""
    wall, force = Wall(1, 0.0, 400.0, 10.0), -100.0
    with mp.workdps(DIGITS):
        fall = Curve.of(mpf(400), mpf(10), mpf(0), mpf(-1), mpf(0))
        push = fall.guard(mpf(0), mpf(-400), mpf(-10))
        least = push.at(next(push.turns()))
        start = force / 400 + force / -least * (1 + mpf(depth))
    return Mass((wall,), duration=2.0, displacement=float(start), force=force)


@pytest.mark.parametrize("depth", DEPTHS)
def test_the_force_of_a_damped_wall_just_vanishes_below_it(depth: float) -> None:
    mass = let_go(depth)
    oracle = OneMass(mass)
    result = agreement(mass.several(), oracle)
    assert result.state_error < EXACT
    assert result.energy_residual < EXACT
    if abs(depth) >= TELLABLE:
        assert [e.after for e in oracle.events] == [RELEASED, CLOSED] * (depth > 0)
        assert result.same_events


def thrown_back(depth: float) -> SeveralStops:
    """Return two equal modes that a preloaded stop throws back, just after another is touched.

    Along the preloaded stop's row (0.6, 0.8) they move as one mass on its spring, across as one on
    none; equal modes have no eigenvectors of their own once both stops push.
    """
    stiffness, mode = 1e4, 1.0
    push, touch = np.array([0.6, 0.8]), np.array([1.0, 0.0])
    across = np.array([-0.8, 0.6])
    velocity = np.array([-1.0, -0.5])
    rate = np.sqrt(stiffness + mode)

    def path(time: float, derivative: int) -> float:
        turn = rate * time + derivative * np.pi / 2
        still = stiffness / rate**2 * (float(derivative == 0) - np.cos(turn) * rate**derivative)
        along = still + velocity @ push * np.sin(turn) * rate ** (derivative - 1)
        beside = velocity @ across * np.sin(time + derivative * np.pi / 2)
        return float(along * (push @ touch) + beside * (across @ touch))

    turn = brentq(lambda time: path(time, 1), 0.0, 1e-3, xtol=1e-18)
    return SeveralStops(
        omega2=np.full(2, mode),
        damping=np.zeros(2),
        stops=(Stop(push, -1.0, stiffness), Stop(touch, -path(turn, 0) - depth, mode)),
        duration=1e-3,
        displacement=np.zeros(2),
        velocity=velocity,
    )


@pytest.mark.parametrize("depth", [1e-6, 1e-8, 1e-10, 1e-12, -1e-12])
def test_equal_modes_leave_a_stop_as_soon_as_they_have_touched_it(depth: float) -> None:
    verdict = compare(problem := thrown_back(depth))
    assert verdict.events == 2 * (depth > 0)
    assert verdict.difference is None
    assert verdict.error < EXACT
    assert problem.solve().event_count == 2 * (depth > 0)


def touched(seed: int, depth: float) -> SeveralStops:
    """Return flexible modes among stops, and one stop more where their motion turns back."""
    problem = random_several(seed)
    problem = problem.but(duration=ScanSolution(problem, 1e3).end)
    history = problem.solve()
    row = np.random.default_rng(seed).normal(size=problem.omega2.size)
    times = np.linspace(0.0, problem.duration, 4001)[1:-1]
    path = history.project(row, times, 0)
    near = int(np.argmin(path))
    turn = brentq(
        lambda time: float(history.project(row, np.array([time]), 1)[0]),
        *(times[near - 1], times[near + 1]),
        xtol=1e-16,
    )
    lowest = float(history.project(row, np.array([turn]), 0)[0])
    gap = -lowest - depth * float(np.abs(path).max())
    return problem.but(stops=(*problem.stops, Stop(row, gap, problem.stops[0].stiffness)))


@pytest.mark.parametrize("depth", [0.0, 1e-9, -1e-9, 1e-12, -1e-12])
@pytest.mark.parametrize("seed", [1, 16])
def test_flexible_modes_just_reach_one_stop_more(seed: int, depth: float) -> None:
    problem = touched(seed, depth)
    judge = PreciseSeveral(problem, 100, 1e6)
    last = len(problem.stops) - 1
    if depth != 0.0:
        assert any(event.stop == last for event in judge.events) == (depth > 0)
    verdict = compare(problem, judge)
    assert verdict.error < EXACT
    assert verdict.energy < EXACT
    if abs(depth) >= TELLABLE:
        assert verdict.difference is None
