"""Dampers of several slopes, exact: closed forms, SciPy, energies, bad input."""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import bumpstop as bs

CURVE = [(-1.0, -130.0), (-0.3, -60.0), (0.0, 0.0), (0.2, 80.0), (1.0, 100.0)]


def damper(**changes: Any) -> bs.DamperLaw:
    usual: dict[str, Any] = {"node": "P", "direction": (1, 0, 0), "damping": (5.0, 40.0, 5.0)}
    return bs.DamperLaw("valve", **usual | {"breaks": (-0.5, 0.5)} | changes)


def problem(*laws: Any, frequency: float = 0.0, speed: float = 1.0) -> bs.Problem:
    mass = bs.ModalBasis.from_modes(
        frequency=[frequency], damping=[0.0], shapes={("P", "dx"): [1.0]}
    )
    start = bs.ModalState(displacement=[0.0], velocity=[speed])
    return bs.Problem(mass, laws=laws, initial=start, duration=1.0)


def test_a_sliding_mass_slows_down_by_one_exponential_after_the_other() -> None:
    """Above 0.5 m/s, v' = -(5 v + 17.5); below, v' = -40 v."""
    response = bs.simulate(problem(damper()), "exact")
    switch = np.log((1.0 + 3.5) / (0.5 + 3.5)) / 5.0
    assert response.event_table()["time"] == pytest.approx([switch], rel=1e-13)
    v = response.sample("velocity", "P", "dx", times=[0.5 * switch, switch + 0.05])
    expected = [4.5 * np.exp(-2.5 * switch) - 3.5, 0.5 * np.exp(-2.0)]
    assert v == pytest.approx(expected, rel=1e-12)
    terms = response.energy_terms([1.0])
    at_end = 0.5 * np.exp(-40.0 * (1.0 - switch))
    assert terms["dissipated_stops"][0] == pytest.approx(0.5 * (1.0 - at_end**2), rel=1e-13)
    assert response.energy_residual < 1e-14


def test_a_shaken_mass_agrees_with_scipy() -> None:
    law = bs.DamperLaw.through(CURVE, "valve", node="P", direction=(1, 0, 0))
    shake = bs.NodalForce("shake", node="P", force=(90.0, 0, 0), time=bs.Harmonic(1.7, sine=1.0))
    base = problem(law, frequency=1.1, speed=-0.1)
    shaken = bs.Problem(base.basis, laws=[law], loads=[shake], initial=base.initial, duration=3.0)
    speeds, forces = np.array(CURVE).T

    def resist(v: float) -> float:
        if v > speeds[-1]:
            return float(forces[-1] + 25.0 * (v - speeds[-1]))
        if v < speeds[0]:
            return float(forces[0] + 100.0 * (v - speeds[0]))
        return float(np.interp(v, speeds, forces))

    omega = 2 * np.pi * 1.1

    def rates(t: float, y: Any) -> Any:
        return [y[1], -(omega**2) * y[0] - resist(y[1]) + 90 * np.sin(2 * np.pi * 1.7 * t)]

    times = np.linspace(0.0, 3.0, 31)
    run = solve_ivp(
        rates, (0, 3.0), [0.0, -0.1], "RK45", times, rtol=1e-12, atol=1e-14, max_step=1e-3
    )
    exact = bs.simulate(shaken, "exact")
    found = exact.sample("displacement", "P", "dx", times=times)
    assert found == pytest.approx(run.y[0], abs=1e-9)
    assert len(exact.event_table()["time"]) > 10
    assert exact.energy_residual < 1e-12
    stepped = bs.simulate(shaken, "dop853", rtol=1e-12)
    assert stepped.sample("displacement", "P", "dx", times=times) == pytest.approx(found, abs=1e-10)
    assert stepped.sample("stop_force", "valve", times=times) == pytest.approx(
        exact.sample("stop_force", "valve", times=times), abs=1e-8
    )
    assert stepped.energy_residual < 1e-10


def test_the_force_follows_its_curve() -> None:
    law = bs.DamperLaw.through(CURVE, "valve", node="P", direction=(1, 0, 0))
    speeds = np.linspace(-1.0, 1.0, 41)
    assert law.force(speeds) == pytest.approx(np.interp(speeds, *np.array(CURVE).T))
    assert law.breaks == (-0.3, 0.0, 0.2)


@pytest.mark.parametrize(
    ("wrong", "key"),
    [
        ({"damping": (1.0, 2.0)}, "damping"),
        ({"damping": (1.0, float("nan"), 2.0)}, "damping"),
        ({"breaks": (0.5, -0.5)}, "breaks"),
        ({"offset": float("inf")}, "offset"),
        ({"direction": None}, "direction"),
    ],
)
def test_bad_input_is_refused(wrong: dict[str, Any], key: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        damper(**wrong)
    assert caught.value.key == key


def test_points_out_of_order_are_refused() -> None:
    with pytest.raises(bs.InputError, match="in the order of speed"):
        bs.DamperLaw.through([(0.0, 0.0), (-1.0, 2.0)], "valve", node="P", direction=(1, 0, 0))
