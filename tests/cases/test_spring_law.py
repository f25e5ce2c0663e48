"""The case spring-law against its closed forms."""

import math
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references

MASS, SOFT, HARD, BREAK = 2.0, 5e3, 20e3, 1e-3
SLOW, FAST = math.sqrt(SOFT / MASS), math.sqrt(HARD / MASS)


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "spring-law" / "case.toml")


@pytest.mark.parametrize(("variant", "number"), [("bilinear", 5), ("play", 3), ("snapping", 4)])
def test_references(case: bs.Case, variant: str, number: int) -> None:
    response = bs.simulate(case.problems[variant], "exact")
    checks = check_references(response, case.references[variant])
    assert len(checks) == number
    assert all(check.passed for check in checks)
    assert response.energy_residual < 1e-13


def test_the_bilinear_period_does_not_depend_on_the_amplitude(case: bs.Case) -> None:
    response = bs.simulate(case.problems["bilinear"], "exact")
    half_periods = np.array([math.pi / FAST, math.pi / SLOW] * 2)
    passings = np.cumsum(half_periods)
    events = response.event_table()["time"]
    assert events[:4] == pytest.approx(passings, rel=1e-12)
    speeds = response.sample("velocity", "P", "dx", times=passings)
    np.testing.assert_allclose(speeds, [-0.5, 0.5, -0.5, 0.5], rtol=1e-12)


def test_the_snapping_mass_passes_its_breaks_when_the_closed_form_says(case: bs.Case) -> None:
    response = bs.simulate(case.problems["snapping"], "exact")
    out = math.asinh(BREAK * SLOW / 0.02) / SLOW
    speed = 0.02 * math.cosh(SLOW * out)
    top = out + (math.pi - math.atan2(4 * speed, FAST * BREAK)) / FAST
    events = response.event_table()["time"]
    assert events[:3] == pytest.approx([out, 2 * top - out, 2 * top + out], rel=1e-9)
