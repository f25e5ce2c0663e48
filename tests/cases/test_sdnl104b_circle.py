"""The case sdnl104b-circle: a round ring against the two planes of sdnl104b."""

from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references

CASES = Path(__file__).parents[2] / "cases"


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(CASES / "sdnl104b-circle" / "case.toml")


@pytest.fixture(scope="module")
def response(case: bs.Case) -> bs.Response:
    return bs.simulate(case.problems["base"], rtol=1e-11)


def test_references(case: bs.Case, response: bs.Response) -> None:
    checks = check_references(response, case.references["base"])
    assert len(checks) == 4
    assert all(check.passed for check in checks)


def test_a_round_ring_is_two_planes(response: bs.Response) -> None:
    planes = bs.load_case(CASES / "sdnl104b" / "case.toml").problems["exact"]
    exact = bs.simulate(planes, "exact")
    times = np.linspace(0.0, 1.0, 201)
    paths = [
        each.sample("displacement", "right.N", "dy", times=times) for each in (exact, response)
    ]
    np.testing.assert_allclose(paths[1], paths[0], rtol=0, atol=1e-9 * np.abs(paths[0]).max())
    both = [each.impact_table() for each in (exact, response)]
    for column in ("start", "peak_force", "impulse"):
        assert both[1][column] == pytest.approx(both[0][column], rel=1e-8)
