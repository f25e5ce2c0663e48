"""The case SDND102A: an oscillator against a wall is half of a pair that mirrors itself."""

from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references

MASS, STIFFNESS, WALL, GAP = 25.0, 98696.0, 5.76e7, 5e-4
OMEGA = 2.0 * np.pi * 10.0
DAMPING = 2.0 * 0.07 * np.sqrt(MASS * STIFFNESS)


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "sdnd102a" / "case.toml")


@pytest.fixture(scope="module")
def response(case: bs.Case) -> bs.Response:
    return bs.simulate(case.problems["exact"], "exact")


@pytest.mark.parametrize(
    ("variant", "number"), [("exact", 41), ("published_wall", 5), ("published_pair", 8)]
)
def test_references(variant: str, number: int, case: bs.Case) -> None:
    method, options = case.methods[variant]
    dt = options["dt"] if method == "symplectic_euler" else None
    checks = check_references(
        bs.simulate(case.problems[variant], method, dt=dt), case.references[variant]
    )
    assert len(checks) == number
    assert all(check.passed for check in checks)


def test_wall_and_mirror_image_are_one(response: bs.Response) -> None:
    times = np.linspace(0.0, 1.0, 2001)
    wall, one, other = (
        response.sample("displacement", node, "dx", times=times) for node in ("W", "P", "Q")
    )
    np.testing.assert_allclose(one, wall, atol=1e-16)
    np.testing.assert_allclose(other, -wall, atol=1e-16)
    force = response.sample("stop_force", "wall", times=times)
    np.testing.assert_allclose(
        response.sample("stop_force", "between", times=times), force, atol=1e-8
    )
    assert response.energy_residual < 1e-12


def test_against_runge_kutta_in_the_frame_of_the_support(response: bs.Response) -> None:
    """The published equation: the motion from the support, and a wall that sees both."""
    from scipy.integrate import solve_ivp

    def rate(time: float, state: np.ndarray) -> list[float]:
        place = state[0] - np.sin(OMEGA * time) / OMEGA**2
        push = WALL * max(0.0, place - GAP)
        own = DAMPING * state[1] + STIFFNESS * state[0]
        return [state[1], -np.sin(OMEGA * time) - (own + push) / MASS]

    times = np.array([0.05, 0.1, 0.156, 0.25, 0.3])
    found = solve_ivp(
        rate, (0.0, 0.3), [0.0, 0.0], "DOP853", t_eval=times, rtol=1e-12, atol=1e-16, max_step=1e-3
    )
    expected = found.y[0] - np.sin(OMEGA * times) / OMEGA**2
    computed = response.sample("displacement", "W", "dx", times=times)
    np.testing.assert_allclose(computed, expected, atol=1e-11)
