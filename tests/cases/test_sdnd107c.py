"""The case sdnd107c against its published curve, and closer with the shaking itself."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "sdnd107c" / "case.toml")


def test_references(case: bs.Case) -> None:
    response = bs.simulate(case.problems["base"], **case.methods["base"].options)
    checks = check_references(response, case.references["base"])
    assert len(checks) == 40
    assert all(check.passed for check in checks)
    assert response.method == "dop853"
    assert response.energy_residual < 1e-12


def test_with_the_sine_itself_the_curve_is_met(case: bs.Case) -> None:
    """While it shakes the load is a harmonic, followed exactly."""
    shaken = bs.BaseMotion(acceleration=(1.0, 0.0, 0.0), time=bs.Harmonic(5.0, sine=1.0))
    problem = replace(case.problems["base"], loads=[shaken], duration=0.8)
    response = bs.simulate(problem, rtol=1e-11)
    checks = {
        "displacement": (5.45161104e-3, ("M", "dx")),
        "stop_force": (0.215184845, ("damper",)),
    }
    for reference in case.references["base"]:
        largest, where = checks[reference.quantity]
        published = np.array(reference.values)[:8]
        times = np.array(reference.times)[:8]
        found = response.sample(reference.quantity, *where, times=times)
        assert np.abs(found - published).max() < 3e-8 * largest
