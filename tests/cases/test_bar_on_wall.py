"""The case bar-on-wall against d'Alembert's solution."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references

SPEED, MASS = 0.1, 7800.0 * 314e-6
WAVE = math.sqrt(210e9 / 7800.0)
BEGIN, END = 5e-4, 5e-4 + 2.0 / WAVE


def moved(place: float, time: float) -> float:
    """Where a point has gone: the wave stops it on its way out and lets it go on its way back."""
    rests, leaves = BEGIN + place / WAVE, END - place / WAVE
    return -SPEED * min(time, rests) + SPEED * max(0.0, time - leaves)


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "bar-on-wall" / "case.toml")


@pytest.fixture(scope="module")
def responses(case: bs.Case) -> dict[str, bs.Response]:
    return {name: bs.simulate(problem, "exact") for name, problem in case.problems.items()}


def test_the_references_are_waves(case: bs.Case) -> None:
    for reference in case.references["stiff"]:
        if reference.quantity == "displacement":
            place = {"A": 0.0, "B": 1.0}.get(str(reference.node), 0.5)
            expected = [moved(place, time) for time in reference.times]
            np.testing.assert_allclose(reference.values, expected, atol=1e-9)


@pytest.mark.parametrize("variant", ["stiff", "rigid"])
def test_references(variant: str, case: bs.Case, responses: dict[str, bs.Response]) -> None:
    checks = check_references(responses[variant], case.references[variant])
    assert len(checks) == 17
    assert all(check.passed for check in checks)


@pytest.mark.parametrize("variant", ["stiff", "rigid"])
def test_momentum_and_energy(variant: str, responses: dict[str, bs.Response]) -> None:
    response = responses[variant]
    flight = response.sample("modal_velocity", 1, times=[0.0, response.problem.duration])
    impulse = math.fsum(response.impact_table()["impulse"])  # type: ignore[arg-type]
    assert flight[0] == pytest.approx(-SPEED * math.sqrt(MASS), rel=1e-11)
    assert flight[1] - flight[0] == pytest.approx(impulse / math.sqrt(MASS), rel=1e-10)
    assert impulse == pytest.approx(2.0 * MASS * SPEED, rel=0.01)
    assert response.energy_residual < 1e-12


@pytest.mark.parametrize("modes", [1, 6, 25])
def test_a_rigid_stop_takes_the_energy_of_the_mass_that_it_feels(modes: int, case: bs.Case) -> None:
    problem = case.problems["rigid"]
    basis = bs.ModalBasis.from_structure(problem.basis.model, modes=modes)  # type: ignore[arg-type]
    response = bs.simulate(replace(problem, basis=basis), "exact")
    terms = response.energy_terms([problem.duration])
    felt = 1.0 / float(np.sum(basis.row("A", "dx") ** 2))
    # Of a bar; the higher modes of a mesh move its ends a little more.
    assert felt == pytest.approx(MASS / (2 * modes - 1), rel=2e-3 * modes)
    assert terms["dissipated_stops"] == pytest.approx([0.5 * felt * SPEED**2], rel=1e-9)
