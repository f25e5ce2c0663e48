"""Where signs are hard to tell: grazing, starts exactly on the stop, rest, and long rest."""

from functools import cache

import numpy as np
import pytest

from .comparison import core_events, measured
from .precise import PreciseSolution
from .problem import StopProblem
from .random_problems import frequencies

DEPTHS = [sign * depth for depth in (1e-3, 1e-4, 1e-6, 1e-8) for sign in (1, -1)]


@cache
def flight(seed: int) -> tuple[StopProblem, float, float]:
    """Return a free flight of six modes, with the least and the largest of ``row . q``."""
    rng = np.random.default_rng(seed)
    omega = frequencies(rng, 6)
    row = rng.normal(size=6)
    problem = StopProblem(
        omega2=omega**2,
        damping=0.02 * omega,
        row=row,
        stiffness=float(1e2 * np.median(omega**2)),
        gap=1e3,
        duration=2.0,
        velocity=np.where(omega > 0, rng.normal(size=6), 0.0),
    )
    times = np.linspace(0.0, problem.duration, 1601)
    path = PreciseSolution(problem).motion(times)[0] @ row
    deepest = minimum(problem, float(times[np.argmin(path)]), float(times[1]))
    return problem, deepest, float(np.abs(path).max())


def minimum(problem: StopProblem, time: float, width: float) -> float:
    """Return the least of ``row . q`` near a time, by bisecting its rate."""
    solution = PreciseSolution(problem)
    left, right = max(time - width, 0.0), time + width
    for _ in range(60):
        middle = (left + right) / 2
        displacement, velocity = solution.motion(np.array([middle]))
        left, right = (left, middle) if velocity[0] @ problem.row > 0 else (middle, right)
    return float(displacement[0] @ problem.row)


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_graze_is_a_contact_only_if_it_touches(seed: int, depth: float) -> None:
    problem, deepest, reach = flight(seed)
    problem = problem.but(gap=-deepest - depth * reach)
    result = measured(problem, PreciseSolution(problem), np.linspace(0, problem.duration, 9), 1.0)
    assert bool(result.found) == (depth > 0)
    assert result.same_events
    assert result.event_error < 1e-12
    assert result.state_error < 1e-12


@pytest.mark.parametrize("depth", [0.0, 1e-9, -1e-9, 1e-12, -1e-12, 1e-15, -1e-15])
@pytest.mark.parametrize("seed", [1, 2])
def test_after_a_graze_that_rounding_may_hide_the_motion_is_right(seed: int, depth: float) -> None:
    problem, deepest, reach = flight(seed)
    problem = problem.but(gap=-deepest - depth * reach)
    result = measured(problem, PreciseSolution(problem), np.linspace(0, problem.duration, 9), 1.0)
    assert result.state_error < 1e-11
    if abs(depth) > 1e-12:
        assert bool(result.found) == (depth > 0)


def pressed(start: float, stop_damping: float = 0.0) -> StopProblem:
    """Return a unit mass pressed onto a stop of 400 N/m by 100 N, let go from a displacement."""
    one = np.ones(1)
    return StopProblem(
        omega2=0 * one,
        damping=0 * one,
        row=one,
        stiffness=400.0,
        stop_damping=stop_damping,
        force=-100.0 * one,
        displacement=start * one,
        duration=1.0,
    )


@pytest.mark.parametrize("depth", DEPTHS)
def test_a_force_that_nearly_vanishes_lets_go_only_if_it_does(depth: float) -> None:
    problem = pressed(-0.25 * (2 + depth))
    oracle = PreciseSolution(problem)
    result = measured(problem, oracle, np.linspace(0.0, 1.0, 9), 1.0)
    assert bool(result.found) == (depth > 0)
    assert result.same_events
    assert result.state_error < 1e-13


@pytest.mark.parametrize(
    ("velocity", "force", "first"),
    [
        ([1.0, 1.0], [0.0, 0.0], "open"),
        ([-1.0, -1.0], [0.0, 0.0], "closed"),
        ([1.0, -1.0], [3.0, -2.0], "open"),
        ([1.0, -1.0], [-3.0, 2.0], "closed"),
        ([0.0, 0.0], [1.0, 2.0], "open"),
        ([0.0, 0.0], [-1.0, -2.0], "closed"),
        # Neither velocity nor acceleration: the next derivative, -omega2 . v, decides.
        ([1.0, -1.0], [0.0, 0.0], "open"),
        ([-1.0, 1.0], [0.0, 0.0], "closed"),
    ],
)
@pytest.mark.parametrize("stop_damping", [0.0, 4.0])
def test_a_start_on_the_stop_is_decided_by_the_first_derivative_that_is_not_zero(
    velocity: list[float], force: list[float], first: str, stop_damping: float
) -> None:
    problem = StopProblem(
        omega2=np.array([16.0, 100.0]),
        damping=np.zeros(2),
        row=np.ones(2),
        stiffness=400.0,
        stop_damping=stop_damping,
        force=np.array(force),
        velocity=np.array(velocity),
        duration=1.3,
    )
    oracle = PreciseSolution(problem)
    assert oracle.steps[0].state == first
    result = measured(problem, oracle, np.linspace(0.0, problem.duration, 14), 1.0)
    assert result.same_events
    assert result.event_error < 1e-13
    assert result.state_error < 1e-13


@pytest.mark.parametrize("stop_damping", [0.0, 4.0])
def test_rest_on_the_stop_stays_rest(stop_damping: float) -> None:
    history = pressed(-0.25, stop_damping).solve()
    times = np.linspace(0.0, 1.0, 11)
    assert core_events(history) == []
    assert history.motion(times, 0) == pytest.approx(np.full((11, 1), -0.25), abs=1e-16)
    assert history.motion(times, 1) == pytest.approx(np.zeros((11, 1)), abs=1e-15)
    assert history.law_motion(0, times)[2] == pytest.approx(np.full(11, 100.0), rel=1e-15)


@pytest.mark.parametrize("stop_damping", [0.0, 4.0])
def test_rest_touching_without_force_stays_rest(stop_damping: float) -> None:
    history = pressed(0.0, stop_damping).but(force=0 * np.ones(1)).solve()
    assert core_events(history) == []
    assert not history.motion(np.linspace(0.0, 1.0, 11), 0).any()
    assert history.energy_residual() == 0.0


def test_a_damped_bounce_settles_on_the_stop() -> None:
    problem = pressed(1.0, stop_damping=8.0).but(duration=20.0)
    oracle = PreciseSolution(problem)
    history = problem.solve()
    assert [e[1:] for e in core_events(history)] == [e[1:] for e in oracle.events]
    assert oracle.steps[-1].state == "closed"
    assert float(history.motion(np.array([20.0]), 0)[0, 0]) == pytest.approx(-0.25, rel=1e-13)


def test_a_stop_that_the_motion_never_reaches_is_never_met() -> None:
    problem = pressed(0.0).but(gap=1e9)
    history = problem.solve()
    assert core_events(history) == []
    assert float(history.motion(np.array([1.0]), 0)[0, 0]) == pytest.approx(-50.0, rel=1e-15)


@pytest.mark.parametrize("shift", [-1e-3, -1e-9, -1e-15, 0.0, 1e-15, 1e-9, 1e-3])
def test_a_closed_phase_near_critical_damping(shift: float) -> None:
    problem = pressed(0.5, stop_damping=40.0 * (1 + shift))
    oracle = PreciseSolution(problem)
    result = measured(problem, oracle, np.linspace(0.0, 1.0, 17), 1.0)
    assert result.same_events
    assert result.state_error < 1e-12
