"""The case hertz-impact against its closed form."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import bumpstop as bs
from bumpstop.post.references import check_references

MASS, STIFFNESS, SPEED, DAMPING = 0.0327, 1.54e10, 1.0, 0.16
DEEPEST = (5 * MASS * SPEED**2 / (4 * STIFFNESS)) ** 0.4
DURATION = 2 * math.sqrt(math.pi) * math.gamma(1.4) / math.gamma(0.9) * DEEPEST / SPEED


def integral(speed: float) -> float:
    """What is the same at both ends of a damped contact."""
    return speed / DAMPING - math.log1p(DAMPING * speed) / DAMPING**2


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "hertz-impact" / "case.toml")


@pytest.mark.parametrize(("variant", "number"), [("elastic", 4), ("damped", 2)])
def test_references(case: bs.Case, variant: str, number: int) -> None:
    response = bs.simulate(case.problems[variant], **case.methods[variant].options)
    checks = check_references(response, case.references[variant])
    assert len(checks) == number
    assert all(check.passed for check in checks)
    assert response.method == "dop853"
    assert response.options["rtol"] == 1e-10


def test_the_elastic_impact(case: bs.Case) -> None:
    response = bs.simulate(case.problems["elastic"], rtol=1e-12)
    impacts = response.impact_table()
    assert impacts["start"] == pytest.approx([1e-4], rel=1e-14)
    assert impacts["duration"] == pytest.approx([DURATION], rel=1e-11)
    assert impacts["peak_force"] == pytest.approx([STIFFNESS * DEEPEST**1.5], rel=1e-11)
    assert impacts["impulse"] == pytest.approx([2 * MASS * SPEED], rel=1e-11)
    assert response.energy_residual < 1e-11


def test_the_damped_impact(case: bs.Case) -> None:
    response = bs.simulate(case.problems["damped"], rtol=1e-12)
    back = brentq(lambda w: integral(-w) - integral(SPEED), 0.5, 1.0, xtol=1e-15)
    impacts = response.impact_table()
    assert impacts["opening_speed"] == pytest.approx([back], rel=1e-11)
    taken = response.energy_terms([3e-4])["dissipated_stops"][0]
    assert taken == pytest.approx(MASS * (SPEED**2 - back**2) / 2, rel=1e-10)
    deepest = (2.5 * MASS / STIFFNESS * integral(SPEED)) ** 0.4
    times = np.linspace(1e-4, 2e-4, 8001)
    assert response.sample("gap", "block", times=times).min() == pytest.approx(-deepest, rel=1e-6)
