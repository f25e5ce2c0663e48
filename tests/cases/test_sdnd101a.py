"""The case SDND101A against its closed form, and against the published scheme written anew."""

import math
from pathlib import Path

import pytest

import bumpstop as bs
from bumpstop.post.references import check_references

FREE, CONTACT = 10.0, math.sqrt(1.01e6 / 100.0)
HALF = math.pi / CONTACT
PERIOD = HALF + math.pi / FREE
CLOSED_FORM = {
    "start": [0.0, PERIOD],
    "end": [HALF, PERIOD + HALF],
    "duration": [HALF] * 2,
    "peak_time": [HALF / 2, PERIOD + HALF / 2],
    "peak_force": [1e6 / CONTACT] * 2,
    "impulse": [2e6 / CONTACT**2] * 2,
    "closing_speed": [1.0] * 2,
    "opening_speed": [1.0] * 2,
    "energy_returned": [0.5e6 / CONTACT**2] * 2,
}


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "sdnd101a" / "case.toml")


@pytest.mark.parametrize("variant", ["exact", "published"])
def test_references(variant: str, case: bs.Case) -> None:
    method = case.methods[variant]
    dt = None if method.name == "exact" else method.options["dt"]
    response = bs.simulate(case.problems[variant], method.name, dt=dt)
    checks = check_references(response, case.references[variant])
    assert len(checks) == (21 if variant == "exact" else 17)
    assert all(check.passed for check in checks)


@pytest.mark.parametrize("quantity", CLOSED_FORM)
def test_impacts_in_closed_form(quantity: str, case: bs.Case) -> None:
    impacts = bs.simulate(case.problems["exact"], "exact").impact_table()
    assert impacts["stop"] == ["wall", "wall"]
    assert impacts[quantity] == pytest.approx(CLOSED_FORM[quantity], rel=1e-13)


def test_the_published_scheme_in_six_lines(case: bs.Case) -> None:
    step, x, v = 5e-4, 0.0, 1.0
    forces, speeds = [], []
    for _ in range(1001):
        forces.append(max(0.0, 1e6 * x))
        speeds.append(v)
        v += step * -(1e4 * x + forces[-1]) / 100.0
        x += step * v
    response = bs.simulate(case.problems["published"], "symplectic_euler", dt=step)
    times = [step * n for n in range(1001)]
    force = response.sample("stop_force", "wall", times=times)
    speed = response.sample("velocity", "P", "dx", times=times)
    assert force == pytest.approx(forces, rel=1e-9, abs=1e-6)
    assert speed == pytest.approx(speeds, abs=1e-11)
