"""The case polar-stop against its closed forms."""

import math
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references

SIDE, OMEGA = 0.04, 1000.0
CONTACT = math.pi / OMEGA
FLIGHT = (SIDE - CONTACT / 2) / 2
THIRD = FLIGHT + CONTACT


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "polar-stop" / "case.toml")


@pytest.mark.parametrize("variant", ["upright", "turned"])
def test_references(case: bs.Case, variant: str) -> None:
    response = bs.simulate(case.problems[variant], **case.methods[variant].options)
    checks = check_references(response, case.references[variant])
    assert len(checks) == 14
    assert all(check.passed for check in checks)
    assert response.method == "dop853"
    assert response.energy_residual < 1e-9


def test_the_pin_goes_round_by_thirds(case: bs.Case) -> None:
    response = bs.simulate(case.problems["upright"], rtol=1e-12)
    starts = FLIGHT / 2 + THIRD * np.arange(6)
    impacts = response.impact_table()
    assert impacts["start"] == pytest.approx(starts, rel=1e-9)
    deepest = [starts[:3] + CONTACT / 2]
    y, z = (response.sample("displacement", "P", dof, times=deepest[0]) for dof in ("dy", "dz"))
    reach = SIDE / math.sqrt(12) + math.sqrt(0.75) / OMEGA
    np.testing.assert_allclose(np.hypot(y, z), reach, rtol=1e-9)
    np.testing.assert_allclose(np.arctan2(z, y), np.radians([30.0, 150.0, -90.0]), rtol=1e-8)
