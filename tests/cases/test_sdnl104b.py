"""The case SDNL104B: a cantilever of two halves, against three published runs."""

from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references

AREA, INERTIA, STEP = np.pi * 0.1**2, np.pi * 0.1**4 / 4, 0.1
MASS = (
    1e6
    * AREA
    * STEP
    / 420
    * np.array(
        [
            [156, 22 * STEP, 54, -13 * STEP],
            [22 * STEP, 4 * STEP**2, 13 * STEP, -3 * STEP**2],
            [54, 13 * STEP, 156, -22 * STEP],
            [-13 * STEP, -3 * STEP**2, -22 * STEP, 4 * STEP**2],
        ]
    )
)
"""Mass matrix of one element in Hermite shape functions, without rotary inertia."""


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(Path(__file__).parents[2] / "cases" / "sdnl104b" / "case.toml")


@pytest.fixture(scope="module")
def published(case: bs.Case) -> bs.Response:
    return bs.simulate(case.problems["published"], "symplectic_euler", dt=1e-5)


def test_the_scheme_of_the_second_run(case: bs.Case) -> None:
    """De Vogelaere's at its largest step: agreement to seven digits.

    The exact displacement, almost zero between two impacts, differs by 1e-6 of it.
    """
    response = bs.simulate(case.problems["exact"], "devogelaere", dt=1e-5)
    published = [
        ("displacement", 0.1315, -1.71881962542e-6),
        ("velocity", 0.1566, -4.48667308637e-3),
    ]
    for quantity, time, value in published:
        found = response.sample(quantity, "right.N", "dy", times=np.array([time]))
        assert found[0] == pytest.approx(value, rel=2e-7)


def test_references(case: bs.Case, published: bs.Response) -> None:
    exact = bs.simulate(case.problems["exact"], "exact")
    for response, variant, number in ((exact, "exact", 9), (published, "published", 10)):
        checks = check_references(response, case.references[variant])
        assert len(checks) == number
        assert all(check.passed for check in checks)
    assert set(exact.impact_table()["stop"]) == {"below"}
    assert exact.energy_residual < 1e-12


@pytest.mark.parametrize(
    ("half", "energy"), [("left", 0.0193738393748), ("right", 0.0493802986221)]
)
def test_kinetic_energies_of_the_halves(half: str, energy: float, published: bs.Response) -> None:
    """Published at 1 s; here from the velocities of the nodes, element by element."""
    velocity = _nodal(published, "velocity", half, 1.0)
    elements = [velocity[2 * first : 2 * first + 4] for first in range(5)]
    assert sum(0.5 * v @ MASS @ v for v in elements) == pytest.approx(energy, rel=2e-11)


def test_stress_at_the_start_is_inertia(published: bs.Response) -> None:
    """Published: 665.452033642 Pa, the end moment of the first element times R / I."""
    moment = (MASS @ _nodal(published, "acceleration", "left", 0.0)[:4])[3]
    assert abs(moment) * 0.1 / INERTIA == pytest.approx(665.452033642, rel=1e-10)


def _nodal(response: bs.Response, quantity: str, half: str, time: float) -> np.ndarray:
    """Return dy and drz of the six nodes of a half, in turn, (12,)."""
    nodes = ["A", *(f"AN.{number}" for number in range(1, 5)), "N"]
    return np.array(
        [
            response.sample(quantity, f"{half}.{node}", dof, times=[time])[0]
            for node in nodes
            for dof in ("dy", "drz")
        ]
    )
