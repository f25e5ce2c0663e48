"""The case ball-on-spring against its closed form, in inches and pounds."""

import math
from pathlib import Path

import pytest

import bumpstop as bs
from bumpstop.post.references import check_references

INCH = 0.0254
POUND_FORCE = 4.4482216152605

MASS, STIFFNESS, HEIGHT, GRAVITY = 0.5, 1973.92, 1.0, 386.0
FALL = math.sqrt(2 * HEIGHT / GRAVITY)
SPEED = math.sqrt(2 * GRAVITY * HEIGHT)
OMEGA = math.sqrt(STIFFNESS / MASS)
SAG = MASS * GRAVITY / STIFFNESS
DEEPEST = SAG + math.hypot(SAG, SPEED / OMEGA)
CLOSED = 2 * (math.pi - math.atan2(SPEED / OMEGA, SAG)) / OMEGA


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "ball-on-spring" / "case.toml")


@pytest.fixture(scope="module")
def response(case: bs.Case) -> bs.Response:
    return bs.simulate(case.problems["base"], "exact")


def test_references(case: bs.Case, response: bs.Response) -> None:
    checks = check_references(response, case.references["base"])
    assert [check.quantity for check in checks] == [
        "impact_start",
        "velocity",
        "energy",
        "displacement",
    ]
    assert all(check.passed for check in checks)


def test_impacts(response: bs.Response) -> None:
    impacts = response.impact_table()
    starts = [FALL + number * (CLOSED + 2 * FALL) for number in range(3)]
    assert impacts["start"] == pytest.approx(starts, rel=1e-12)
    assert impacts["closing_speed"] == pytest.approx([SPEED * INCH] * 3, rel=1e-12)
    assert impacts["end"][:2] == pytest.approx([start + CLOSED for start in starts[:2]], rel=1e-12)
    assert impacts["peak_time"][0] == pytest.approx(FALL + CLOSED / 2, rel=1e-9)
    assert impacts["peak_force"][0] == pytest.approx(STIFFNESS * DEEPEST * POUND_FORCE, rel=1e-12)


def test_motion(response: bs.Response) -> None:
    deepest = FALL + CLOSED / 2
    height = response.sample("displacement", "P", "dz", times=[0.0, FALL, deepest])
    assert height == pytest.approx([0.0, -INCH, -(HEIGHT + DEEPEST) * INCH], rel=1e-12)
    energy = response.energy_terms([FALL])
    expected = MASS * GRAVITY * HEIGHT * POUND_FORCE * INCH
    assert energy["kinetic"][0] == pytest.approx(expected, rel=1e-12)
    assert response.energy_residual < 1e-13


def test_the_ball_comes_back_to_where_it_was_dropped(response: bs.Response) -> None:
    back = 2 * FALL + CLOSED
    state = [response.sample(quantity, "P", "dz", times=[back])[0] for quantity in MOTION]
    assert state == pytest.approx([0.0, 0.0], abs=1e-12)


MOTION = ("displacement", "velocity")
