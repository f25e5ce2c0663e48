"""The case buckling-stop against its closed forms."""

import math
from pathlib import Path

import pytest

import bumpstop as bs
from bumpstop.post.references import check_references

MASS, STIFFNESS, CRITICAL, AFTER, GAP = 100.0, 1e6, 10e3, 5e3, 0.02


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "buckling-stop" / "case.toml")


@pytest.mark.parametrize(("variant", "number"), [("elastic", 4), ("crushed", 10), ("plateau", 5)])
def test_references(case: bs.Case, variant: str, number: int) -> None:
    response = bs.simulate(case.problems[variant], **case.methods[variant].options)
    checks = check_references(response, case.references[variant])
    assert len(checks) == number
    assert all(check.passed for check in checks)
    assert response.method == "exact"
    assert response.energy_residual < 1e-13


def test_it_is_crushed_stage_by_stage(case: bs.Case) -> None:
    response = bs.simulate(case.problems["crushed"], "exact")
    omega = math.sqrt(STIFFNESS / MASS)
    touches = GAP / 2.0
    buckles = touches + math.asin(CRITICAL / (2.0 * math.sqrt(STIFFNESS * MASS))) / omega
    speed = math.sqrt(4.0 - CRITICAL**2 / (STIFFNESS * MASS))
    turns = buckles + speed * MASS / AFTER
    unloading = AFTER / (CRITICAL / STIFFNESS)
    leaves = turns + math.pi / 2 / math.sqrt(unloading / MASS)
    expected = [touches, buckles, turns, leaves]
    assert response.event_table()["time"] == pytest.approx(expected, rel=1e-12)
