"""The case sdnd107c against its published curve, and closer with the shaking itself."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.methods import usable_options
from bumpstop.post.references import check_references


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "sdnd107c" / "case.toml")


@pytest.fixture(scope="module")
def responses(case: bs.Case) -> dict[str, bs.Response]:
    return {
        variant: bs.simulate(
            case.problems[variant], method.name, **usable_options(*method, case.problems[variant])
        )
        for variant, method in case.methods.items()
    }


@pytest.mark.parametrize("variant", ["converged", "published"])
def test_references(case: bs.Case, responses: dict[str, bs.Response], variant: str) -> None:
    checks = check_references(responses[variant], case.references[variant])
    assert len(checks) == 40
    assert all(check.passed for check in checks)


def test_the_converged_run_is_in_balance(responses: dict[str, bs.Response]) -> None:
    assert responses["converged"].energy_residual < 1e-12


def test_the_published_scheme_strays_as_the_deck_did(responses: dict[str, bs.Response]) -> None:
    """The deck's own statistic over all instants of its curve, here against the converged run."""
    times = np.concatenate([np.arange(81) * 0.01, 0.8 + np.arange(1, 121) * 0.02])
    known = {
        "displacement": (5.51957958e-4, ("M", "dx")),
        "stop_force": (4.45667677e-4, ("damper",)),
    }
    for quantity, (strayed, where) in known.items():
        found, curve = (
            responses[variant].sample(quantity, *where, times=times)
            for variant in ("published", "converged")
        )
        assert np.abs(found - curve).max() / np.abs(curve).max() == pytest.approx(strayed, rel=2e-4)


def test_with_the_sine_itself_the_curve_is_met(case: bs.Case) -> None:
    """While it shakes the load is a harmonic, followed exactly."""
    shaken = bs.BaseMotion(acceleration=(1.0, 0.0, 0.0), time=bs.Harmonic(5.0, sine=1.0))
    problem = replace(case.problems["converged"], loads=[shaken], duration=0.8)
    response = bs.simulate(problem, rtol=1e-11)
    checks = {
        "displacement": (5.45161104e-3, ("M", "dx")),
        "stop_force": (0.215184845, ("damper",)),
    }
    for reference in case.references["converged"]:
        largest, where = checks[reference.quantity]
        published = np.array(reference.values)[:8]
        times = np.array(reference.times)[:8]
        found = response.sample(reference.quantity, *where, times=times)
        assert np.abs(found - published).max() < 3e-8 * largest
