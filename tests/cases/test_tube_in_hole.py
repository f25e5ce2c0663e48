"""The case tube-in-hole against its closed forms, and its report."""

from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references
from bumpstop.report.orbit import orbit


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "tube-in-hole" / "case.toml")


@pytest.mark.parametrize(("variant", "number"), [("sliding", 3), ("whirling", 4)])
def test_references(case: bs.Case, variant: str, number: int) -> None:
    response = bs.simulate(case.problems[variant], **case.methods[variant].options)
    checks = check_references(response, case.references[variant])
    assert len(checks) == number
    assert all(check.passed for check in checks)
    assert response.method == "dop853"
    assert response.energy_residual < 1e-9


def test_the_tube_wears_the_floor_it_slides_on(case: bs.Case) -> None:
    response = bs.simulate(case.problems["sliding"], rtol=1e-10)
    work = bs.wear_work(response, "hole", end=0.05)
    assert work.distance == pytest.approx(6.25e-3, rel=1e-8)
    assert work.work == pytest.approx(62.5e-3, rel=1e-8)
    sectors = bs.work_by_sector(response, "hole", sectors=4, end=0.05)
    # y and z are both negative, or z is zero, where it lies: the quarters meet there.
    assert float(sectors.sum()) == pytest.approx(work.rate, rel=1e-6)
    assert sectors.values[0] == sectors.values[3] == 0.0


def test_the_orbit_is_drawn_with_the_circle_that_is_reached(case: bs.Case) -> None:
    problem = case.problems["whirling"]
    response = bs.simulate(problem, rtol=1e-10)
    law = problem.laws[0]
    assert isinstance(law, bs.CircleStop)
    figure = orbit(response, law)
    path, *_, border = figure["data"]
    np.testing.assert_allclose(np.hypot(path["x"], path["y"]), 800.0, rtol=1e-6)  # µm
    np.testing.assert_allclose(np.hypot(border["x"], border["y"]), 600.0, rtol=1e-12)
    assert figure["layout"]["xaxis"]["title"]["text"] == "Along y (µm)"
    assert figure["layout"]["yaxis"]["title"]["text"] == "Along z (µm)"
