"""The case tube-by-tube against its closed forms and integrals."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

import bumpstop as bs
from bumpstop.post.references import check_references

REDUCED, STIFFNESS, REACH, SPEED, BESIDE = 0.75, 1e6, 0.02, 1.0, 0.012
ENERGY = REDUCED * SPEED**2 / 2
SPIN = REDUCED * SPEED * BESIDE


def radial(r: float) -> float:
    """Half the reduced mass times the square of the radial speed."""
    return ENERGY - SPIN**2 / (2 * REDUCED * r**2) - STIFFNESS * (REACH - r) ** 2 / 2


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "tube-by-tube" / "case.toml")


@pytest.mark.filterwarnings("ignore:stop 'between'. the structure:bumpstop.ModellingWarning")
@pytest.mark.parametrize(("variant", "number"), [("head_on", 6), ("oblique", 11), ("within", 10)])
def test_references(case: bs.Case, variant: str, number: int) -> None:
    response = bs.simulate(case.problems[variant], **case.methods[variant].options)
    checks = check_references(response, case.references[variant])
    assert len(checks) == number
    assert all(check.passed for check in checks)
    assert response.method == "dop853"
    assert response.energy_residual < 1e-9


def test_the_oblique_impact_is_the_integral_of_its_radial_speed(case: bs.Case) -> None:
    nearest = brentq(radial, REACH - 1e-3, REACH, xtol=1e-16, rtol=1e-15)
    way = REACH - nearest

    def seconds(s: float) -> float:  # over s with r = nearest + way s^2, which is smooth
        r = nearest + way * s * s
        return float(2 * way * s / math.sqrt(2 * radial(r) / REDUCED))

    nodes, weights = np.polynomial.legendre.leggauss(20)
    half = sum(weight * seconds(s) / 2 for s, weight in zip((1 + nodes) / 2, weights, strict=True))
    impacts = bs.simulate(case.problems["oblique"], rtol=1e-12).impact_table()
    assert impacts["duration"] == pytest.approx([2 * half], rel=1e-8)
    assert impacts["peak_force"] == pytest.approx([STIFFNESS * way], rel=1e-9)


def test_momentum_and_spin_stay(case: bs.Case) -> None:
    response = bs.simulate(case.problems["oblique"], rtol=1e-12)
    place = {
        n: [float(response.sample("displacement", n, d, times=[0.03])[0]) for d in DOFS]
        for n in MASSES
    }
    speed = {
        n: [float(response.sample("velocity", n, d, times=[0.03])[0]) for d in DOFS] for n in MASSES
    }
    for axis, expected in enumerate((1.0, 0.0)):
        assert sum(m * speed[n][axis] for n, m in MASSES.items()) == pytest.approx(
            expected, abs=1e-10
        )
    place["B"][0] += 0.03
    spin = sum(
        m * (place[n][0] * speed[n][1] - place[n][1] * speed[n][0]) for n, m in MASSES.items()
    )
    assert spin == pytest.approx(-BESIDE, rel=1e-9)


DOFS = ("dy", "dz")
MASSES = {"A": 1.0, "B": 3.0}
