"""The case user-law against Mathieu functions of SciPy."""

from pathlib import Path

import numpy as np
import pytest
from scipy.special import mathieu_a, mathieu_cem

import bumpstop as bs
from bumpstop.post.references import check_references

CASE = Path(__file__).parents[2] / "cases" / "user-law" / "case.toml"


def test_references() -> None:
    case = bs.load_case(CASE)
    response = bs.simulate(case.problems["base"], "dop853", rtol=1e-11)
    checks = check_references(response, case.references["base"])
    assert len(checks) == 8
    assert all(check.passed for check in checks)
    assert response.energy_residual < 1e-10


def test_the_values_are_those_of_mathieu_functions() -> None:
    (law,) = bs.load_case(CASE).problems["base"].laws
    assert isinstance(law, bs.UserLaw)
    assert law.force(1.0, 0.0, 0.5 * np.pi / 2.0) == pytest.approx(-mathieu_a(2, 1.0), rel=1e-12)
    times = np.array([1.0, 2.0, 5.0, 10.0])
    values, rates = mathieu_cem(2, 1.0, np.degrees(times))
    start, _ = mathieu_cem(2, 1.0, 0.0)
    place, speed = bs.load_case(CASE).references["base"]
    np.testing.assert_allclose(place.values, 1e-3 * values / start, rtol=1e-8)
    np.testing.assert_allclose(speed.values, 1e-3 * rates / start, rtol=1e-8)
