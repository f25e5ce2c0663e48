"""The case SDND100A against Coulomb's closed form."""

from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references

PEAKS = np.array([-0.65e-3, 0.45e-3, -0.25e-3, 0.05e-3]) / np.sqrt(2.0)


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "sdnd100a" / "case.toml")


@pytest.fixture(scope="module")
def responses(case: bs.Case) -> dict[str, bs.Response]:
    return {
        name: bs.simulate(problem, case.methods[name].name, **case.methods[name].options)
        for name, problem in case.problems.items()
    }


@pytest.mark.parametrize("variant", ["published", "rigid", "steps"])
def test_references(variant: str, case: bs.Case, responses: dict[str, bs.Response]) -> None:
    checks = check_references(responses[variant], case.references[variant])
    assert len(checks) == 8
    assert all(check.passed for check in checks)


def test_it_stays_where_friction_holds_it(responses: dict[str, bs.Response]) -> None:
    response = responses["rigid"]
    times = np.linspace(4 * np.pi / 100, 0.3, 50)
    rests = response.sample("displacement", "P", "dy", times=times)
    np.testing.assert_allclose(rests, PEAKS[3], rtol=1e-5)
    assert np.abs(response.sample("velocity", "P", "dy", times=times[1:])).max() < 1e-8


def test_the_floor_carries_the_weight_and_the_ledger_closes(
    responses: dict[str, bs.Response],
) -> None:
    """Friction takes mu N times the way of all slides, 0.65 + ... from peak to peak."""
    response = responses["rigid"]
    assert response.sample("stop_force", "floor") == pytest.approx(10.0, rel=1e-12)
    slides = 0.85e-3 + 2 * (0.65e-3 + 0.45e-3 + 0.25e-3) + 0.05e-3
    dissipated = response.energy_terms([0.3])["dissipated_stops"]
    assert dissipated == pytest.approx([1.0 * slides], rel=1e-5)
    assert response.energy_residual < 1e-12


def test_without_the_damper_of_the_stick_the_last_peak_is_lost(case: bs.Case) -> None:
    """The trap of the published text: the deviations that a contact of 4e5 N/m alone has."""
    from dataclasses import replace

    problem = case.problems["published"]
    bare = [replace(stop, tangential_damping=0.0) for stop in problem.laws]  # type: ignore[type-var]
    response = bs.simulate(replace(problem, laws=bare), "exact")
    peaks = response.sample("displacement", "P", "dy", times=np.arange(1, 5) * np.pi / 100)
    published = [2.7e-4, 1.6e-3, 4.6e-3, 4.3e-2]
    references = np.array([-4.596e-4, 3.182e-4, -1.768e-4, 3.536e-5])
    np.testing.assert_allclose(np.abs(peaks / references - 1.0), published, rtol=0.02)


def test_small_steps_lead_to_the_law_that_is_solved_exactly(
    case: bs.Case, responses: dict[str, bs.Response]
) -> None:
    """The published friction is the same but for how a step finds it."""
    peaks = np.arange(1, 5) * np.pi / 100.0
    exact = responses["published"].sample("displacement", "P", "dy", times=peaks)
    errors = []
    for dt in (1e-4, 2.5e-5):
        response = bs.simulate(case.problems["steps"], "symplectic_euler", dt=dt)
        found = response.sample("displacement", "P", "dy", times=peaks)
        errors.append(np.abs(found - exact).max())
    assert errors[1] < 0.5 * errors[0]
    assert errors[1] < 1e-7
