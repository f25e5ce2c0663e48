"""SDND100A by the published scheme, step and friction."""

from pathlib import Path

import numpy as np

import bumpstop as bs
from bumpstop.post.references import check_references

CASES = Path(__file__).parents[2] / "cases"


def test_all_published_digits() -> None:
    case = bs.load_case(CASES / "sdnd100a-steps" / "case.toml")
    response = bs.simulate(case.problems["base"], "symplectic_euler", dt=5e-4)
    checks = check_references(response, case.references["base"])
    assert len(checks) == 4
    assert all(check.passed for check in checks)


def test_small_steps_lead_to_the_law_that_is_solved_exactly() -> None:
    """Its stick is the same but for how a step finds it."""
    problem = bs.load_case(CASES / "sdnd100a-steps" / "case.toml").problems["base"]
    published = bs.load_case(CASES / "sdnd100a" / "case.toml").problems["published"]
    peaks = np.arange(1, 5) * np.pi / 100.0
    exact = bs.simulate(published, "exact").sample("displacement", "P", "dy", times=peaks)
    errors = []
    for dt in (1e-4, 2.5e-5):
        response = bs.simulate(problem, "symplectic_euler", dt=dt)
        found = response.sample("displacement", "P", "dy", times=peaks)
        errors.append(np.abs(found - exact).max())
    assert errors[1] < 0.5 * errors[0]
    assert errors[1] < 1e-7
