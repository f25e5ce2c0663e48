"""The case SDNL111A against waves in bars, and against a matrix exponential."""

import runpy
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.post.references import check_references

FOLDER = Path(__file__).parents[2] / "cases" / "sdnl111a"
LENGTH, ELEMENTS, AREA, MODULUS, DENSITY = 1.0, 50, 4e-4, 2e11, 7800.0


@pytest.fixture(scope="module")
def case() -> bs.Case:
    return bs.load_case(FOLDER / "case.toml")


@pytest.fixture(scope="module")
def response(case: bs.Case) -> bs.Response:
    return bs.simulate(case.problems["exact"], "exact")


@pytest.mark.parametrize("variant", ["exact", "published"])
def test_references(variant: str, case: bs.Case) -> None:
    method = case.methods[variant].name
    dt = 1e-6 if method == "symplectic_euler" else None
    checks = check_references(
        bs.simulate(case.problems[variant], method, dt=dt), case.references[variant]
    )
    assert len(checks) == 10
    assert all(check.passed for check in checks)


def test_the_closed_form_of_the_case_file(case: bs.Case) -> None:
    """The values in the file are those of the script, to the digits written."""
    waves = runpy.run_path(str(FOLDER / "tables.py"))["waves"]
    reference = next(each for each in case.references["exact"] if "d'Alembert" in each.source)
    np.testing.assert_allclose(waves(np.array(reference.times)), reference.values, atol=5e-13)


def test_the_damper_pushes_from_the_first_instant(response: bs.Response) -> None:
    impacts = response.impact_table()
    assert impacts["start"] == [0.0]
    assert impacts["closing_speed"] == pytest.approx([1.0], rel=1e-12)
    assert response.sample("stop_force", "faces", times=[0.0]) == pytest.approx([2e4], rel=1e-12)
    assert response.energy_residual < 1e-12


def test_contact_and_flight_by_matrix_exponentials(response: bs.Response) -> None:
    """Forty modes of SciPy; contact until the force is gone, then free flight."""
    from scipy.linalg import expm
    from scipy.optimize import brentq

    omega2, row, velocity = _modes()
    size = len(omega2)
    still, one = np.zeros((size, size)), np.eye(size)
    free = np.block([[still, one], [-np.diag(omega2), -2e-3 * np.diag(np.sqrt(omega2))]])
    push = np.concatenate([-5e9 * row, -2e4 * row])
    closed = free + np.concatenate([np.zeros(size), row])[:, np.newaxis] * push
    start = np.concatenate([np.zeros(size), velocity])
    gone = brentq(lambda t: push @ expm(closed * t) @ start, 7e-4, 8.2e-4, xtol=1e-16)
    released = expm(closed * gone) @ start
    for time in (1e-4, 3.5e-4, 4e-4, 7.5e-4, 8e-4, 1e-3):
        state = (
            expm(closed * time) @ start if time < gone else expm(free * (time - gone)) @ released
        )
        distance = response.sample("gap", "faces", times=[time])
        force = response.sample("stop_force", "faces", times=[time])
        assert distance == pytest.approx([row @ state[:size]], abs=1e-14)
        assert force == pytest.approx([max(0.0, push @ state) * (time < gone)], abs=1e-5)


def test_faces_that_are_round_as_in_the_third_run(case: bs.Case, response: bs.Response) -> None:
    """Circles of 5 um about each node, 10 um apart: along one line they are planes."""
    round_faces = bs.CircleStop(
        "faces",
        node="A",
        other="C",
        axis=(0, 1, 0),
        centre=(-1e-5, 0.0, 0.0),
        radius=5e-6,
        body_radius=5e-6,
        side="outside",
        stiffness=5e9,
        damping=2e4,
    )
    problem = replace(case.problems["exact"], laws=[round_faces])
    found = bs.simulate(problem, rtol=1e-11)
    assert found.method == "dop853"
    times = np.linspace(0.0, 1e-3, 41)
    paths = [each.sample("displacement", "A", "dx", times=times) for each in (response, found)]
    np.testing.assert_allclose(paths[1], paths[0], rtol=0, atol=1e-9 * 2e-4)


def _modes() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return squared frequencies, the row of the distance and the initial velocity of 40 modes."""
    from scipy.linalg import block_diag, eigh

    h = LENGTH / ELEMENTS
    stiffness, mass = np.zeros((2, ELEMENTS + 1, ELEMENTS + 1))
    for element in range(ELEMENTS):
        place = slice(element, element + 2)
        stiffness[place, place] += MODULUS * AREA / h * np.array([[1, -1], [-1, 1]])
        mass[place, place] += DENSITY * AREA * h / 6 * np.array([[2, 1], [1, 2]])
    # The flying bar first; of the held one the last node is left out.
    both = [block_diag(matrix, matrix[:-1, :-1]) for matrix in (stiffness, mass)]
    omega2, shapes = eigh(*both, subset_by_index=[0, 39])
    omega2[0] = 0.0
    flying = np.concatenate([np.ones(ELEMENTS + 1), np.zeros(ELEMENTS)])
    return omega2, shapes[0] - shapes[ELEMENTS + 1], -shapes.T @ both[1] @ flying
