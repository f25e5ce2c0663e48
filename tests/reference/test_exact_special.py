"""Modal data at which formulas divide by nothing: rigid, equal, critical, uncoupled, extreme."""

import numpy as np
import pytest

from .comparison import measured
from .precise import PreciseSolution
from .problem import Array, StopProblem

STATE_ERROR, EVENT_ERROR = 1e-10, 1e-12


def three_modes(**changes: float | Array) -> StopProblem:
    """Return a rigid and two flexible modes thrown at a stop, with what is special put in."""
    omega = np.array([0.0, 20.0, 64.0])
    return StopProblem(
        omega2=omega**2,
        damping=np.array([0.0, 0.4, 1.0]),
        row=np.array([1.0, -0.5, 0.7]),
        stiffness=1e3,
        gap=0.01,
        velocity=np.array([-1.0, 0.7, 0.3]),
        duration=0.5,
    ).but(**changes)


def check(problem: StopProblem, state_error: float = STATE_ERROR) -> None:
    """Compare events and states with the oracle, and close the energy ledger."""
    times: Array = np.linspace(0.0, problem.duration, 21)[1:]
    result = measured(problem, PreciseSolution(problem), times, 1.0)
    assert result.same_events
    assert result.event_error < EVENT_ERROR
    assert result.state_error < state_error
    assert problem.solve().energy_residual() < 1e-11


PUSH = np.array([-30.0, 3.0, 0.0])


@pytest.mark.parametrize("stop_damping", [0.0, 5.0])
@pytest.mark.parametrize("damping", [(0.0, 0.0), (2.0, 2.0)])
def test_two_rigid_modes_that_both_move_the_stop(
    damping: tuple[float, float], stop_damping: float
) -> None:
    rates, damped = np.array([0.0, 0.0, 4096.0]), np.array([*damping, 1.0])
    check(three_modes(omega2=rates, damping=damped, force=PUSH, stop_damping=stop_damping))


@pytest.mark.parametrize("drag", [1e-12, 1e-8, 1e-4, 1e-2, 0.1, 1.0, 1e3])
def test_a_rigid_mode_with_drag(drag: float) -> None:
    check(three_modes(damping=np.array([drag, 0.4, 1.0]), force=PUSH), state_error=1e-12)


def weakly_coupled_critical_mode(coupling: float, stop_damping: float) -> StopProblem:
    """Return a problem whose closed phase has two nearly equal roots, apart by the coupling."""
    return three_modes(
        damping=np.array([0.0, 40.0, 1.0]),
        row=np.array([1.0, coupling, 0.7]),
        stop_damping=stop_damping,
    )


@pytest.mark.parametrize("coupling", [1.0, 1e-1, 1e-2, 0.0])
@pytest.mark.parametrize("stop_damping", [0.0, 0.5])
def test_a_critically_damped_mode_coupled_weakly(coupling: float, stop_damping: float) -> None:
    check(weakly_coupled_critical_mode(coupling, stop_damping))


@pytest.mark.parametrize(
    "problem",
    [
        weakly_coupled_critical_mode(1e-4, 0.0),
        weakly_coupled_critical_mode(1e-9, 0.5),
        three_modes(
            omega2=np.array([400.0, 400.0 * (1 + 1e-12), 3600.0]),
            damping=np.array([40.0, 40.0, 120.0]),
            force=PUSH,
        ),
        three_modes(
            omega2=np.array([400.0, 400.0, 400.0]),
            damping=np.array([40.0, 40.0, 40.0]),
            row=np.array([1.0, -0.5, 1e-7]),
        ),
    ],
)
def test_roots_that_nearly_or_wholly_coincide(problem: StopProblem) -> None:
    check(problem, state_error=1e-11)


@pytest.mark.parametrize("drags", [(0.0, 2.0), (0.5, 2.0), (1e-6, 0.0), (3.0, 3.0 + 1e-9)])
@pytest.mark.parametrize("stop_damping", [0.0, 5.0])
def test_rigid_modes_of_different_drag_under_a_push(
    drags: tuple[float, float], stop_damping: float
) -> None:
    problem = three_modes(
        omega2=np.array([0.0, 0.0, 4096.0]),
        damping=np.array([*drags, 1.0]),
        force=PUSH,
        stop_damping=stop_damping,
    )
    check(problem, state_error=1e-11)


@pytest.mark.parametrize("coupling", [1e-1, 1e-3, 1e-6, 1e-9, 0.0])
def test_a_lightly_damped_mode_coupled_weakly(coupling: float) -> None:
    check(three_modes(row=np.array([1.0, coupling, 0.7])), state_error=1e-12)


@pytest.mark.parametrize(
    ("omega2", "damping"),
    [
        ((400.0, 400.0, 400.0), (0.1, 0.1, 0.1)),
        ((400.0, 400.0, 400.0), (0.1, 0.1, 40.0)),
        ((400.0, 400.0 * (1 + 1e-13), 400.0 * (1 + 1e-9)), (0.1, 0.1, 0.1)),
        ((400.0, 400.0, 3600.0), (40.0, 40.0, 120.0)),
        ((400.0, 400.0, 3600.0), (400.0, 41.0, 1e4)),
        ((1e-12, 400.0, 4096.0), (0.0, 0.4, 1.0)),
        ((1e-6, 400.0, 4096.0), (0.0, 0.4, 1.0)),
    ],
)
def test_equal_and_nearly_equal_modes(
    omega2: tuple[float, ...], damping: tuple[float, ...]
) -> None:
    check(three_modes(omega2=np.array(omega2), damping=np.array(damping), force=PUSH))


@pytest.mark.parametrize("stiffness", [0.1, 1.0, 1e6, 1e9, 1e12, 1e15])
def test_stops_from_very_soft_to_very_stiff(stiffness: float) -> None:
    # A soft stop's static deflection under the push is large: its rounding is what remains.
    static = 1e-15 * float(np.abs(PUSH).max()) / stiffness / 0.01
    problem = three_modes(stiffness=stiffness, force=PUSH, duration=0.02)
    check(problem, state_error=max(1e-13, static))


@pytest.mark.parametrize("stop_damping", [1e-8, 1e-3, 1.0, 1e2, 1e4])
def test_stop_dampers_from_weak_to_overdamped(stop_damping: float) -> None:
    check(three_modes(stop_damping=stop_damping), state_error=1e-12)


@pytest.mark.parametrize("gap", [-1.0, 0.0, 1.0])
def test_a_stop_that_no_mode_moves_does_nothing(gap: float) -> None:
    check(three_modes(row=np.zeros(3), gap=gap), state_error=1e-13)


@pytest.mark.parametrize(
    ("gap", "stop_damping", "speed"), [(-0.3, 0.0, -1.0), (-0.3, 5.0, -1.0), (-0.01, 5e3, 5.0)]
)
def test_a_start_below_the_stop(gap: float, stop_damping: float, speed: float) -> None:
    velocity = np.array([speed, 0.7, 0.3])
    check(three_modes(gap=gap, stop_damping=stop_damping, velocity=velocity), state_error=1e-12)


def test_hundreds_of_modes() -> None:
    rng = np.random.default_rng(4)
    number = np.arange(1, 201)
    omega = 20 * np.pi * (number + rng.uniform(-0.1, 0.1, 200))
    problem = StopProblem(
        omega2=omega**2,
        damping=0.02 * omega,
        row=np.sqrt(2) * np.sin(0.37 * np.pi * number),
        stiffness=1e6,
        gap=0.001,
        velocity=np.where(number <= 6, rng.normal(size=200), 0.0),
        duration=0.008,
    )
    assert problem.solve().event_count >= 3
    check(problem, state_error=1e-12)
