"""The case sdnd103a."""

from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "sdnd103a" / "case.toml")


@pytest.mark.parametrize("variant", ["converged", "published"])
def test_references(case: bs.Case, variant: str) -> None:
    method = case.methods[variant]
    response = bs.simulate(case.problems[variant], method.name, **method.options)
    checks = check_references(response, case.references[variant])
    assert len(checks) == 15
    assert all(check.passed for check in checks)


def test_it_converges_to_the_sine_with_its_threshold(case: bs.Case) -> None:
    """Without the threshold in the law it is the sine, to what lines make of the shaking."""
    from dataclasses import replace

    problem = case.problems["converged"]
    (law,) = problem.laws
    assert isinstance(law, bs.ForceRelation)
    plain = replace(problem, laws=[replace(law, force="1e6 * x * abs(x)")])
    times = np.linspace(0.0, 18.0, 37)
    x = bs.simulate(plain, "dop853", rtol=1e-11).sample("displacement", "M", "dx", times=times)
    assert np.abs(x - 0.01 * np.sin(np.pi * times / 4)).max() < 1e-8
