"""The case sdnd120a."""

from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "sdnd120a" / "case.toml")


@pytest.fixture(scope="module")
def response(case: bs.Case) -> bs.Response:
    method = case.methods["base"]
    return bs.simulate(case.problems["base"], method.name, **method.options)


def test_references(case: bs.Case, response: bs.Response) -> None:
    checks = check_references(response, case.references["base"])
    assert len(checks) == 8
    assert all(check.passed for check in checks)
    assert response.energy_residual < 1e-6


def test_the_rms_value_is_the_published_one(response: bs.Response) -> None:
    times = np.arange(0.0, 0.9981, 0.002)
    x = response.sample("displacement", "M2", "dx", times=times)
    rms = np.sqrt(np.trapezoid(x**2, times) / 0.998)
    assert rms == pytest.approx(0.0118, rel=1e-2)
    assert rms == pytest.approx(0.011832520, rel=1e-6)
