"""The case sdnd105a."""

from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "sdnd105a" / "case.toml")


@pytest.mark.parametrize(("variant", "count"), [("exact", 6), ("stepped", 1)])
def test_references(case: bs.Case, variant: str, count: int) -> None:
    method = case.methods[variant]
    response = bs.simulate(case.problems[variant], method.name, **method.options)
    checks = check_references(response, case.references[variant])
    assert len(checks) == count
    assert all(check.passed for check in checks)


def test_it_buckles_when_two_sines_are_one(case: bs.Case) -> None:
    response = bs.simulate(case.problems["exact"], "exact")
    table = response.event_table()
    at = dict(zip(table["guard"], table["time"], strict=True))
    assert at["buckling"] == pytest.approx(np.pi / 6, rel=1e-7)
    assert at["turn back"] == pytest.approx(np.pi / 6 + 2 * np.sqrt(3), rel=1e-6)
    assert response.energy_residual < 1e-12
