"""The case moving-stop against its closed forms."""

import math
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references

STIFFNESS, AMPLITUDE, DRIVEN = 250e3, 0.2e-3, 100 * math.pi
OMEGA = math.sqrt(STIFFNESS)


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "moving-stop" / "case.toml")


@pytest.mark.filterwarnings("ignore:stop 'wall'. its gap:bumpstop.ModellingWarning")
@pytest.mark.parametrize("method", ["symplectic_euler", "central_difference"])
@pytest.mark.parametrize("variant", ["coming", "shaking"])
def test_fixed_steps_tend_to_it(case: bs.Case, variant: str, method: str) -> None:
    """Motion and ledger, with the work of the obstacle: a tenth of the step, a tenth or less."""
    problem = case.problems[variant]
    exact = bs.simulate(problem, "exact")
    times = np.linspace(0.0, problem.duration, 201)
    expected = exact.history.motion(times, 0)
    work = exact.energy_terms([problem.duration])["obstacle_work"][0]
    errors = []
    for steps in (1_000, 10_000):
        found = bs.simulate(problem, method, dt=problem.duration / steps)
        apart = np.abs(found.history.motion(times, 0) - expected).max() / np.abs(expected).max()
        lack = found.energy_terms([problem.duration])["obstacle_work"][0] / work - 1.0
        assert found.event_count == exact.event_count
        errors.append([apart, abs(lack), found.energy_residual])
    assert errors[0][0] < 2e-4
    assert errors[0][1] < 1e-3
    assert (np.array(errors[1]) < 0.11 * np.array(errors[0])).all()


@pytest.mark.filterwarnings("ignore:stop 'wall'. its gap:bumpstop.ModellingWarning")
@pytest.mark.parametrize(("variant", "number"), [("coming", 8), ("shaking", 6)])
def test_references(case: bs.Case, variant: str, number: int) -> None:
    response = bs.simulate(case.problems[variant], "exact")
    checks = check_references(response, case.references[variant])
    assert len(checks) == number
    assert all(check.passed for check in checks)
    assert response.energy_residual < 1e-12


@pytest.mark.filterwarnings("ignore:stop 'wall'. its gap:bumpstop.ModellingWarning")
def test_the_table_never_lets_go_of_the_mass(case: bs.Case) -> None:
    response = bs.simulate(case.problems["shaking"], "exact")
    times = np.linspace(0.0, 0.04, 401)
    ratio = DRIVEN / OMEGA
    wave = np.sin(DRIVEN * times) - ratio * np.sin(OMEGA * times)
    place = AMPLITUDE * wave / (1.0 - ratio**2)
    force = 250.0 + STIFFNESS * (AMPLITUDE * np.sin(DRIVEN * times) - place)
    assert force.min() > 0.0
    found = response.sample("stop_force", "wall", times=times)
    np.testing.assert_allclose(found, force, rtol=0, atol=1e-9 * force.max())
