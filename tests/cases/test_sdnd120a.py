"""The case sdnd120a."""

from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.methods import usable_options
from bumpstop.post.references import check_references


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "sdnd120a" / "case.toml")


@pytest.fixture(scope="module")
def responses(case: bs.Case) -> dict[str, bs.Response]:
    return {
        variant: bs.simulate(
            case.problems[variant], method.name, **usable_options(*method, case.problems[variant])
        )
        for variant, method in case.methods.items()
    }


@pytest.mark.parametrize(("variant", "energy"), [("converged", 1e-6), ("published", 1e-5)])
def test_references(
    case: bs.Case, responses: dict[str, bs.Response], variant: str, energy: float
) -> None:
    checks = check_references(responses[variant], case.references[variant])
    assert len(checks) == 8
    assert all(check.passed for check in checks)
    assert responses[variant].energy_residual < energy


@pytest.mark.parametrize(("variant", "error"), [("converged", 1e-6), ("published", 1e-8)])
def test_the_rms_value_is_the_published_one(
    responses: dict[str, bs.Response], variant: str, error: float
) -> None:
    times = np.arange(0.0, 0.9981, 0.002)
    x = responses[variant].sample("displacement", "M2", "dx", times=times)
    rms = np.sqrt(np.trapezoid(x**2, times) / 0.998)
    assert rms == pytest.approx(0.0118, rel=1e-2)
    assert rms == pytest.approx(0.011832520, rel=error)
