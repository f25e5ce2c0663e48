"""The case SDND102A by motions of supports: the same as by the forces that these make."""

from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references

CASES = Path(__file__).parents[2] / "cases"


@pytest.fixture(scope="module")
def by_forces() -> bs.Response:
    case = bs.load_case(CASES / "sdnd102a" / "case.toml")
    return bs.simulate(case.problems["exact"], "exact")


def test_it_meets_its_references_and_is_the_case_by_forces(by_forces: bs.Response) -> None:
    case = bs.load_case(CASES / "sdnd102a-supports" / "case.toml")
    response = bs.simulate(case.problems["base"], "exact")
    checks = check_references(response, case.references["base"])
    assert len(checks) == 41
    assert all(check.passed for check in checks)
    times = np.linspace(0.0, 1.0, 1001)
    for node in "WPQ":
        for quantity in ("displacement", "velocity"):
            one, two = (
                each.sample(quantity, node, "dx", times=times) for each in (response, by_forces)
            )
            np.testing.assert_allclose(one, two, atol=1e-12 * np.abs(two).max())
    assert response.event_count == by_forces.event_count
    wave = np.sin(20 * np.pi * times) / (20 * np.pi) ** 2
    for support, sign in (("SW", -1), ("SP", -1), ("SQ", 1)):
        moved = response.sample("displacement", support, "dx", times=times)
        np.testing.assert_allclose(moved, sign * wave, atol=1e-18)
    assert response.energy_residual < 1e-12
