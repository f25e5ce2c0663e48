"""Zener dampers: other variables integrated by SciPy, the linear one, energies, bad input."""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

import bumpstop as bs

PARTS = {
    "series_stiffness": 900.0,
    "parallel_stiffness": 150.0,
    "branch_stiffness": 600.0,
    "damping": 8.0,
}


def damper(**changes: Any) -> bs.ZenerDamper:
    usual: dict[str, Any] = {"node": "P", "direction": (1, 0, 0)} | PARTS
    return bs.ZenerDamper("damper", **usual | changes)


def shaken(law: bs.ZenerDamper, *others: bs.Stop, duration: float = 1.5) -> bs.Problem:
    basis = bs.ModalBasis.from_modes(
        frequency=[1.0, 4.0], damping=[0.0, 0.01], shapes={("P", "dx"): [1.0, 0.7]}
    )
    force = bs.NodalForce("shake", node="P", force=(3.0, 0, 0), time=bs.Harmonic(2.2, sine=1.0))
    return bs.Problem(basis, laws=[law, *others], loads=[force], duration=duration)


@pytest.mark.parametrize(("exponent", "parallel"), [(0.5, 150.0), (0.35, 0.0), (1.0, 40.0)])
def test_it_agrees_with_the_rates_of_the_force_by_scipy(exponent: float, parallel: float) -> None:
    """SciPy integrates the force itself, by its own rate, as the published description does."""
    law = damper(exponent=exponent, parallel_stiffness=parallel)
    problem = shaken(law)
    times = np.linspace(0.0, problem.duration, 31)
    k1, k2, k3 = law.series_stiffness, parallel, law.branch_stiffness
    omega, row = 2 * np.pi * np.array([1.0, 4.0]), np.array([1.0, 0.7])

    def rates(t: float, y: Any) -> Any:
        q, v, force = y[:2], y[2:4], y[4]
        branch = force * (1 + k2 / k1) - k2 * (row @ q)
        slip = np.sign(branch) * (abs(branch) / law.damping) ** (1 / exponent)
        change = ((row @ v) * (1 + k2 / k3) - slip) / (1 / k1 + 1 / k3 + k2 / (k1 * k3))
        load = 3.0 * np.sin(2 * np.pi * 2.2 * t) - force
        damping = np.array([0.0, 0.02 * omega[1]])
        return [*v, *(row * load - omega**2 * q - damping * v), change]

    run = solve_ivp(
        rates, (0.0, problem.duration), np.zeros(5), "DOP853", times, rtol=1e-12, atol=1e-14
    )
    for method, rtol in (("dop853", 1e-11), ("rk54", 1e-11)):
        response = bs.simulate(problem, method, rtol=rtol)
        motion = response.history.motion(times, 0)
        assert motion == pytest.approx(run.y[:2].T, abs=1e-8 * np.abs(run.y[:2]).max())
        force = -response.sample("stop_force", "damper", times=times)
        assert force == pytest.approx(run.y[4], abs=1e-8 * np.abs(run.y[4]).max())
        assert response.energy_residual < 1e-9


def test_a_linear_dashpot_is_a_matrix_exponential() -> None:
    """A mass is let go; with the dashpot's elongation w it is a linear system of three."""
    law = damper(parallel_stiffness=0.0)
    basis = bs.ModalBasis.from_modes(frequency=[0.0], damping=[0.0], shapes={("P", "dx"): [1.0]})
    start = bs.ModalState(displacement=[0.01], velocity=[0.3])
    problem = bs.Problem(basis, laws=[law], initial=start, duration=1.0)
    response = bs.simulate(problem, rtol=1e-12)
    both = 1 / (1 / law.series_stiffness + 1 / law.branch_stiffness)
    matrix = np.array([[0, 1, 0], [-both, 0, both], [both / law.damping, 0, -both / law.damping]])
    for time in (0.1, 0.5, 1.0):
        expected = expm(matrix * time) @ [0.01, 0.3, 0.0]
        x = response.sample("displacement", "P", "dx", times=[time])[0]
        assert x == pytest.approx(expected[0], abs=1e-13)
        force = response.sample("stop_force", "damper", times=[time])[0]
        assert force == pytest.approx(-both * (expected[0] - expected[2]), abs=1e-9)
    terms = response.energy_terms([1.0])
    lost = 0.5 * 0.3**2 + 0.5 * both * 0.01**2 - terms["kinetic"][0] - terms["stored"][0]
    assert terms["dissipated_stops"][0] == pytest.approx(lost, rel=1e-10)


def test_it_stands_beside_stops() -> None:
    """The memory goes on through the switches of another law."""
    stop = bs.Stop("wall", node="P", normal=(-1, 0, 0), gap=2e-3, stiffness=1e5, damping=20.0)
    problem = shaken(damper(exponent=0.5), stop, duration=3.0)
    runs = [bs.simulate(problem, method, rtol=1e-11) for method in ("dop853", "rk54")]
    times = np.linspace(0.0, 3.0, 61)
    first, second = (run.history.motion(times, 0) for run in runs)
    assert np.abs(first - second).max() < 1e-8 * np.abs(first).max()
    assert len(runs[0].impact_table()["start"]) > 3
    assert max(run.energy_residual for run in runs) < 1e-8


def test_auto_takes_an_adaptive_method_and_says_why() -> None:
    response = bs.simulate(shaken(damper(), duration=0.1))
    assert response.method == "dop853"
    assert "'damper' is not piecewise linear: its dashpot" in response.method_reason


@pytest.mark.parametrize(
    ("wrong", "key"),
    [
        ({"series_stiffness": 0.0}, "series_stiffness"),
        ({"parallel_stiffness": -1.0}, "parallel_stiffness"),
        ({"branch_stiffness": float("inf")}, "branch_stiffness"),
        ({"damping": -8.0}, "damping"),
        ({"exponent": 1.2}, "exponent"),
        ({"exponent": 0.0}, "exponent"),
        ({"direction": (0, 0, 0)}, "direction"),
        ({"other": "P"}, "other"),
    ],
)
def test_bad_input_is_refused(wrong: dict[str, Any], key: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        damper(**wrong)
    assert caught.value.key == key


def test_a_node_that_does_not_move_is_refused() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [0.0]})
    with pytest.raises(bs.InputError, match="no mode deforms this damper"):
        bs.Problem(basis, laws=[damper()], duration=1.0)


def test_the_report_tells_what_it_is_made_of() -> None:
    from bumpstop.report.summary import model_rows

    told = dict(model_rows(shaken(damper(exponent=0.5))))["Laws"][0]
    assert told.startswith("damper: a Zener damper at P along (1, 0, 0), springs of 900 N/m")
    assert told.endswith("dashpot of 8 N at 1 m/s, power 0.5")
