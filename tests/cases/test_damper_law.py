"""The case damper-law against its closed forms."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import expm

import bumpstop as bs
from bumpstop.post.references import check_references

MASS = 10.0


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "damper-law" / "case.toml")


@pytest.mark.parametrize(("variant", "number"), [("valve", 8), ("absorber", 6)])
def test_references(case: bs.Case, variant: str, number: int) -> None:
    response = bs.simulate(case.problems[variant], "exact")
    checks = check_references(response, case.references[variant])
    assert len(checks) == number
    assert all(check.passed for check in checks)
    assert response.energy_residual < 1e-13


def test_the_valve_closes_once(case: bs.Case) -> None:
    response = bs.simulate(case.problems["valve"], "exact")
    assert response.event_table()["time"] == pytest.approx([math.log(8.8 / 8.0) / 5.0], rel=1e-13)


def test_the_absorber_goes_by_one_matrix_exponential_after_the_other(case: bs.Case) -> None:
    response = bs.simulate(case.problems["absorber"], "exact")
    state, time = np.array([0.01, 0.0]), 0.0
    for number in range(3):
        damping = (600.0, 120.0)[number % 2]
        matrix = np.array([[0.0, 1.0], [-36e3 / MASS, -damping / MASS]])
        turned = math.pi / math.sqrt(36e3 / MASS - (damping / (2 * MASS)) ** 2)
        times = [time + part * turned for part in (0.3, 0.7, 1.0)]
        expected = np.array([expm(matrix * (each - time)) @ state for each in times])
        for quantity, column in zip(("displacement", "velocity"), expected.T, strict=True):
            found = response.sample(quantity, "P", "dx", times=times)
            np.testing.assert_allclose(found, column, rtol=0, atol=1e-12)
        state, time = expected[-1], times[-1]
