"""The case ball-on-floor against its closed forms: infinitely many impacts, rest, lifting off."""

import math
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references

MASS, GRAVITY, RESTITUTION = 2.0, 9.81, 0.5
FALL, SPEED = math.sqrt(2 / GRAVITY), math.sqrt(2 * GRAVITY)


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "ball-on-floor" / "case.toml")


@pytest.fixture(scope="module")
def response(case: bs.Case) -> bs.Response:
    return bs.simulate(case.problems["base"], "exact")


def test_references(case: bs.Case, response: bs.Response) -> None:
    checks = check_references(response, case.references["base"])
    assert len(checks) == 13
    assert all(check.passed for check in checks)


def test_rest_comes_early_by_no_more_than_the_resolution_allows(response: bs.Response) -> None:
    (settled,) = (
        time
        for time, guard in zip(*map(response.event_table().get, ("time", "guard")), strict=True)
        if guard == "settling"
    )
    rest = FALL * (1 + RESTITUTION) / (1 - RESTITUTION)
    # The largest sum of the terms of the distance: the gap, and twice the fall in parts.
    early = math.sqrt(8e-12 * 4 / GRAVITY) / (1 - RESTITUTION)
    assert rest - early < settled <= rest * (1 + 1e-12)


def test_the_law_tells_its_states_and_its_reaction(response: bs.Response) -> None:
    times = np.array([0.2, 1.9, 2.4, 2.6])
    assert response.sample("state", "floor", times=times).tolist() == [
        "open",
        "resting",
        "resting",
        "open",
    ]
    force = response.sample("stop_force", "floor", times=times)
    expected = [0.0, MASS * GRAVITY, 0.2 * MASS * GRAVITY, 0.0]
    assert force == pytest.approx(expected, rel=1e-11)
    assert response.energy_residual < 1e-12


@pytest.mark.parametrize("resolution", [1e-4, 1e-8, 1e-12])
def test_the_resolution_says_how_many_impacts_are_followed(
    case: bs.Case, resolution: float
) -> None:
    problem = case.problems["base"]
    basis, loads = problem.basis, problem.loads
    floor = bs.RigidStop(
        "floor",
        node="P",
        normal=(0, 0, 1),
        gap=1.0,
        restitution=RESTITUTION,
        resolution=resolution,
    )
    coarse = bs.simulate(bs.Problem(basis, laws=[floor], loads=loads, duration=1.9))
    impacts = sum(guard == "impact" for guard in coarse.event_table()["guard"])
    # Heights fall by e^2 from 1 m on; the motion's size is some metres.
    expected = math.log(resolution) / math.log(RESTITUTION**2)
    assert expected - 2 < impacts <= expected + 1
    with pytest.raises(bs.InputError, match="resolution: must be from 1e-13 to 1"):
        bs.RigidStop("floor", node="P", normal=(0, 0, 1), restitution=0.5, resolution=1e-14)
