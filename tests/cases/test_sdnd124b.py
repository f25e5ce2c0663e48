"""The case sdnd124b."""

from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "sdnd124b" / "case.toml")


def test_references(case: bs.Case) -> None:
    response = bs.simulate(case.problems["sampled"], "exact")
    checks = check_references(response, case.references["sampled"])
    assert len(checks) == 90
    assert all(check.passed for check in checks)
    assert response.energy_residual < 1e-12
    # As far as an independent integration was found to differ from the published values.
    worst = {"stop_force": 7.6e-3, "displacement": 3.0e-3, "energy": 1.5e-3}
    for reference in case.references["sampled"]:
        own = check_references(response, [reference])
        found = max(abs(check.value / check.reference - 1.0) for check in own)
        assert 0.9 * worst[reference.quantity] < found < worst[reference.quantity]


def test_the_curve_is_that_of_the_deck(case: bs.Case) -> None:
    (law,) = case.problems["sampled"].laws
    assert isinstance(law, bs.HardeningSpring)
    p = np.arange(0.0, 40.0, 0.01)
    deck = 200 + 400 * p / (1 + (400 * p / 250) ** 1.5) ** (1 / 1.5)
    assert np.abs(law.force(p + 0.5) - deck).max() < 0.016
