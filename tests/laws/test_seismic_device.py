"""Seismic devices: their springs in closed form, a classical scheme in tiny steps, energies."""

from typing import Any

import numpy as np
import pytest

import bumpstop as bs

from .one_mass import one_mass, runge_kutta, shaking
from .stretches import Change, Stretch, in_stretches

PARTS: dict[str, Any] = {
    "first_stiffness": 6e3,
    "second_stiffness": 500.0,
    "threshold": 12.0,
    "damping": 40.0,
    "exponent": 0.2,
    "stroke": 0.03,
}


def device(**changes: Any) -> bs.SeismicDevice:
    return bs.SeismicDevice("device", node="P", direction=(1, 0, 0), **PARTS | changes)


def test_force_and_energy_of_the_spring_are_those_of_its_formula() -> None:
    law = device(damping=0.0)
    response = bs.simulate(one_mass(law, speed=0.5, duration=0.3), rtol=1e-12)
    times = np.linspace(0.0, 0.3, 31)
    x = response.sample("displacement", "P", "dx", times=times)
    v = response.sample("velocity", "P", "dx", times=times)
    bent = np.sqrt(1 + (6e3 * x / 12.0) ** 2)
    assert -response.sample("stop_force", "device", times=times) == pytest.approx(
        500.0 * x + 5500.0 * x / bent, rel=1e-13
    )
    stored = 250.0 * x**2 + 5500.0 * (12.0 / 6e3) ** 2 * (bent - 1.0)
    assert response.energy_terms(times)["stored"] == pytest.approx(stored, rel=1e-11, abs=1e-17)
    assert 0.5 * v**2 + stored == pytest.approx(0.125, rel=1e-11)


def test_a_shaken_mass_agrees_with_tiny_steps() -> None:
    """The damper's force has cusps: steps of a scheme that does not see them are poor."""
    law = device(rest_speed=1e-3)
    problem = one_mass(law, speed=0.3, loads=[shaking(60.0, 3.0)], duration=0.6)

    def rates(t: float, y: list[float]) -> list[float]:
        x, v = y
        spring = 500.0 * x + 5500.0 * x / np.sqrt(1 + (500.0 * x) ** 2)
        damper = 40.0 * abs(x / 0.03) ** 0.2 * v / (v * v + 1e-6) ** 0.4
        return [v, 60.0 * np.sin(6 * np.pi * t) - spring - damper]

    states = np.array(runge_kutta(rates, [0.0, 0.3], 0.6, 12000))
    for method in ("dop853", "rk54"):
        response = bs.simulate(problem, method, rtol=1e-10)
        x = response.sample("displacement", "P", "dx", times=np.linspace(0, 0.6, 61))
        assert np.abs(x - states[::200, 0]).max() < 2e-5 * np.abs(x).max()
        assert response.energy_residual < 1e-8
        assert set(response.event_table()["guard"]) == {"no elongation"}
        assert response.energy_terms([0.6])["dissipated_stops"][0] > 0.1


@pytest.mark.parametrize("rtol", [1e-6, 1e-10])
def test_a_sign_that_a_moving_support_changes_is_changed_once(rtol: float) -> None:
    """The elongation passes zero at a speed of which its own rounding knows nothing."""
    problem = bs.load_case("cases/sdnd120a/case.toml").problems["converged"]
    events = bs.simulate(problem, rtol=rtol).event_table()
    assert events["after"] == ["long"]
    assert events["time"][0] == pytest.approx(0.5000013, abs=1e-7)


def test_force_and_motion_are_those_of_scipy() -> None:
    """Stretch by stretch between the instants without elongation, where the damper has its cusp."""
    law = device(rest_speed=0.05, exponent=0.5)
    problem = one_mass(law, speed=0.3, loads=[shaking(60.0, 3.0)], duration=0.6)

    def force(x: Any, v: Any) -> Any:
        spring = 500.0 * x + 5500.0 * x / np.sqrt(1 + (500.0 * x) ** 2)
        return spring + 40.0 * np.abs(x / 0.03) ** 0.5 * v / (v * v + 0.0025) ** 0.25

    def rates(t: float, y: Any) -> Any:
        return [y[1], 60.0 * np.sin(6 * np.pi * t) - force(*y)]

    def side(sign: float) -> Stretch:
        return Stretch(rates, [Change(lambda y: y[0], -sign, lambda _: side(-sign))])

    times = np.linspace(0.0, 0.6, 61)
    x, v = in_stretches(side(1.0), [0.0, 0.3], times).T
    response = bs.simulate(problem, rtol=1e-13)
    found = response.sample("displacement", "P", "dx", times=times)
    assert np.abs(found - x).max() < 1e-8 * np.abs(x).max()
    acting = -response.sample("stop_force", "device", times=times)
    expected = force(x, v)
    # At the start the elongation is zero: its rounding is all that the damper's root sees.
    assert np.abs(acting - expected)[1:].max() < 1e-8 * np.abs(expected).max()


def test_the_force_is_what_acts() -> None:
    law = device()
    problem = one_mass(law, place=0.01, speed=-0.4, duration=0.01)
    acting = bs.simulate(problem, rtol=1e-10).sample("stop_force", "device", times=[0.0])[0]
    assert -acting == pytest.approx(law.force([0.01], -0.4)[0], rel=1e-13)
    slope = (law.static_force(0.01 + 1e-7)[0] - law.static_force(0.01 - 1e-7)[0]) / 2e-7
    assert law.static_force(0.01)[1] == pytest.approx(slope, rel=1e-6)


@pytest.mark.parametrize(
    ("wrong", "key"),
    [
        ({"first_stiffness": 0.0}, "first_stiffness"),
        ({"second_stiffness": 7e3}, "second_stiffness"),
        ({"threshold": -1.0}, "threshold"),
        ({"exponent": 1.5}, "exponent"),
        ({"stroke": 0.0}, "stroke"),
        ({"rest_speed": 0.0}, "rest_speed"),
        ({"damping": -1.0}, "damping"),
    ],
)
def test_bad_input_is_refused(wrong: dict[str, Any], key: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        device(**wrong)
    assert caught.value.key == key
