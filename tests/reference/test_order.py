"""Fixed-step schemes approach the oracle at their order where nothing switches."""

import numpy as np
import pytest

from .precise import PreciseSolution
from .problem import Array, StopProblem

STEPS = [1e-4 / 2**n for n in range(4)]
TIMES: Array = np.arange(1, 11, dtype=np.float64) * 0.02


def always_closed() -> StopProblem:
    """Return three damped modes pressed so hard onto a damped stop that they never leave it."""
    omega = np.array([0.0, 60.0, 150.0])
    row = np.array([1.0, 0.8, -0.6])
    return StopProblem(
        omega2=omega**2,
        damping=0.04 * omega,
        row=row,
        stiffness=5e3,
        stop_damping=2.0,
        force=np.array([-60.0, 4.0, 9.0]),
        displacement=np.array([-0.011, 0.0, 0.0]),
        velocity=np.array([0.02, 0.1, -0.1]),
        duration=0.2,
    )


@pytest.fixture(scope="module")
def exact() -> tuple[Array, Array]:
    solution = PreciseSolution(always_closed())
    assert solution.events == []
    assert solution.steps[0].state == "closed"
    return solution.motion(TIMES)


@pytest.mark.parametrize("derivative", [0, 1])
@pytest.mark.parametrize(
    ("method", "order"),
    [
        ("symplectic_euler", 1),
        ("central_difference", 2),
        ("newmark", 2),
        ("hht", 2),
        ("generalized_alpha", 2),
        ("trbdf2", 2),
        ("exponential", 2),
        ("devogelaere", 4),
    ],
)
def test_order_over_four_steps(
    method: str, order: int, derivative: int, exact: tuple[Array, Array]
) -> None:
    problem = always_closed()
    # A high order comes down to rounding early.
    coarser = 4 if order > 2 else 1
    errors = [
        np.abs(problem.solve(method, dt).motion(TIMES, derivative) - exact[derivative]).max()
        for dt in coarser * np.array(STEPS)
    ]
    observed = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert observed == pytest.approx(np.full(3, float(order)), abs=0.05)
    assert errors[-1] < 0.05 * np.abs(exact[derivative]).max()
