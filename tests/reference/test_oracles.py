"""The oracles against closed forms, against each other and against the published columns."""

import numpy as np
import pytest

from . import sdnl32
from .precise import PreciseSolution
from .problem import StopProblem
from .quick import QuickSolution
from .random_problems import random_problem

ORACLES = (PreciseSolution, QuickSolution)
Oracle = type[PreciseSolution] | type[QuickSolution]


def free_mass(**changes: float) -> StopProblem:
    """Return a unit mass thrown at a stop of 400 N/m from half a metre, at 2 m/s."""
    one = np.ones(1)
    return StopProblem(
        omega2=0 * one, damping=0 * one, row=one, stiffness=400.0, gap=0.5, duration=1.0
    ).but(velocity=-2.0 * one, **changes)


@pytest.mark.parametrize("oracle", ORACLES)
def test_a_free_mass_stays_half_a_period_on_its_stop(oracle: Oracle) -> None:
    solution = oracle(free_mass())
    assert [event[1:] for event in solution.events] == [("open", "closed"), ("closed", "open")]
    assert [e[0] for e in solution.events] == pytest.approx([0.25, 0.25 + np.pi / 20], rel=1e-14)
    displacement, velocity = solution.motion(np.array([0.25 + np.pi / 40, 1.0]))
    assert displacement[:, 0] == pytest.approx([-0.6, -0.5 + 2 * (0.75 - np.pi / 20)], rel=1e-13)
    assert velocity[:, 0] == pytest.approx([0.0, 2.0], abs=1e-13)


@pytest.mark.parametrize("oracle", ORACLES)
def test_a_damped_stop_lets_go_before_the_gap_opens(oracle: Oracle) -> None:
    ratio, rate = 0.3, 20.0
    damped = rate * np.sqrt(1 - ratio**2)
    solution = oracle(free_mass(stop_damping=2 * ratio * rate))
    # The acceleration of exp(-ratio rate t) sin(damped t) vanishes first at this time.
    release = np.arctan2(2 * ratio * np.sqrt(1 - ratio**2), 2 * ratio**2 - 1) / damped
    depth = -2 / damped * np.exp(-ratio * rate * release) * np.sin(damped * release)
    speed = 2 / damped * np.exp(-ratio * rate * release)
    speed *= ratio * rate * np.sin(damped * release) - damped * np.cos(damped * release)
    assert [event[1:] for event in solution.events] == [
        ("open", "closed"),
        ("closed", "released"),
        ("released", "open"),
    ]
    assert [event[0] for event in solution.events] == pytest.approx(
        [0.25, 0.25 + release, 0.25 + release - depth / speed], rel=1e-13
    )


@pytest.mark.parametrize("oracle", ORACLES)
def test_the_ball_on_a_spring_of_the_verification_manual(oracle: Oracle) -> None:
    mass, stiffness, height, gravity = 0.5, 1973.92, 1.0, 386.0
    row = np.array([1 / np.sqrt(mass)])
    solution = oracle(
        StopProblem(
            omega2=np.zeros(1),
            damping=np.zeros(1),
            row=row,
            gap=height,
            stiffness=stiffness,
            force=-mass * gravity * row,
            duration=0.3,
        )
    )
    rate, fall = np.sqrt(stiffness / mass), np.sqrt(2 * height / gravity)
    static, speed = gravity / rate**2, np.sqrt(2 * gravity * height)
    deepest: float = fall + (np.pi / 2 + np.arctan(static * rate / speed)) / rate
    contact = 2 * (deepest - fall)
    assert [event[0] for event in solution.events] == pytest.approx(
        [fall, fall + contact, 3 * fall + contact], rel=1e-13
    )
    depth = solution.motion(np.array([deepest]))[0][0] @ row
    assert -depth - height == pytest.approx(static + np.hypot(static, speed / rate), rel=1e-13)
    assert deepest == pytest.approx(0.10044, abs=5e-6)


@pytest.mark.parametrize("stiffness", sdnl32.EXACT)
def test_the_card_of_sdnl32(stiffness: float) -> None:
    problem = sdnl32.clean(stiffness)
    solution = PreciseSolution(problem)
    tip = solution.motion(sdnl32.TIMES)[0] @ problem.row
    # What is left is the card's own double-precision eigenvalue solver.
    assert tip == pytest.approx(np.array(sdnl32.EXACT[stiffness]), abs=1e-11 * np.abs(tip).max())
    assert [event[1:] for event in solution.events] == [("closed", "open")]
    assert solution.events[0][0] == pytest.approx(sdnl32.LOST_CONTACT[stiffness], abs=2e-14)


@pytest.mark.parametrize("seed", range(12))
def test_the_oracles_agree(seed: int) -> None:
    problem = random_problem(seed)
    precise, quick = PreciseSolution(problem), QuickSolution(problem)
    assert [event[1:] for event in precise.events] == [event[1:] for event in quick.events]
    times = np.linspace(0.0, problem.duration, 9)
    for left, right in zip(precise.motion(times), quick.motion(times), strict=True):
        assert left == pytest.approx(right, abs=1e-9 * np.abs(left).max())
