"""The case outside-program against its closed form."""

from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references

CASE = Path(__file__).parents[2] / "cases" / "outside-program" / "case.toml"
STEP = 1e-4


@pytest.fixture(scope="module")
def response() -> bs.Response:
    problem = bs.load_case(CASE).problems["base"]
    return bs.simulate(problem, "symplectic_euler", dt=STEP)


def switches(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return times and speeds of the relay's switches in closed form."""
    speeds = [0.5, np.sqrt(0.25 + 4.0 * 0.01)]
    while len(speeds) <= count:
        speeds.append(np.sqrt(speeds[-1] ** 2 + 4.0 * 0.02))
    each = np.array(speeds)
    return np.cumsum(0.5 * (each[1:] + each[:-1])), each[1:]


def test_references() -> None:
    case = bs.load_case(CASE)
    response = bs.simulate(case.problems["base"], "symplectic_euler", dt=2e-5)
    checks = check_references(response, case.references["base"])
    assert len(checks) == 12
    assert all(check.passed for check in checks)


def test_it_switches_when_the_closed_form_says(response: bs.Response) -> None:
    times, speeds = switches(3)
    steps = np.arange(0.0, 2.0, STEP)
    force = response.sample("stop_force", "relay", times=steps)
    found = steps[1:][np.diff(force) != 0.0]
    # Each switch is up to a step late, which the next ones feel, too.
    np.testing.assert_allclose(found, times, rtol=0, atol=8 * STEP)
    passed = np.abs(response.sample("velocity", "P", "dx", times=found))
    np.testing.assert_allclose(passed, speeds, rtol=0, atol=8 * STEP)


def test_a_second_run_finds_the_program_as_it_begins(response: bs.Response) -> None:
    again = bs.simulate(response.problem, "symplectic_euler", dt=STEP)
    times = np.linspace(0.0, 2.0, 21)
    np.testing.assert_array_equal(
        again.sample("displacement", "P", "dx", times=times),
        response.sample("displacement", "P", "dx", times=times),
    )
