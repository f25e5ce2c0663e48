"""Response spectra against closed forms, an ODE solver and Duhamel's integral."""

import math
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import solve_ivp

import bumpstop as bs
from bumpstop.arguments import FloatArray
from bumpstop.post.response_spectrum import oscillator


def over_time(times: Any, values: Any) -> xr.DataArray:
    at = np.asarray(times, dtype=float)
    attrs = {"units": "m/s^2"}
    return xr.DataArray(np.asarray(values), coords={"time": at}, dims="time", attrs=attrs)


def test_a_long_step_doubles_the_static_deflection() -> None:
    step = over_time([0.0, 10.0], [3.0, 3.0])
    found = bs.response_spectrum(step, [1.0, 7.0], 0.0)
    np.testing.assert_allclose(found, 6.0, rtol=1e-6)
    damped = bs.response_spectrum(step, [2.0], 0.1)
    overshoot = 1.0 + math.exp(-math.pi * 0.1 / math.sqrt(0.99))
    assert float(damped[0]) == pytest.approx(3.0 * overshoot, rel=1e-6)


@pytest.mark.parametrize("ratio", [0.2, 0.4, 0.6, 1.0, 1.7])
def test_a_rectangular_pulse(ratio: float) -> None:
    """2 sin(pi f T) below f T = 1/2, and 2 above (Biot; Chopra, section 4.7)."""
    pulse = over_time([0.0, 0.1], [5.0, 5.0])
    expected = 5.0 * (2.0 if ratio >= 0.5 else 2.0 * math.sin(math.pi * ratio))
    found = bs.response_spectrum(pulse, [ratio / 0.1], 0.0)
    assert float(found[0]) == pytest.approx(expected, rel=1e-6)


def test_sides_and_the_time_after() -> None:
    pulse = over_time([0.0, 0.1], [5.0, 5.0])
    hertz = [2.0]
    during = float(bs.response_spectrum(pulse, hertz, 0.0, after=False)[0])
    assert during == pytest.approx(5.0 * (1.0 - math.cos(0.4 * math.pi)), rel=1e-6)
    largest = 10.0 * math.sin(0.2 * math.pi)
    for side in ("positive", "negative"):
        found = bs.response_spectrum(pulse, hertz, 0.0, side=side)
        assert float(found[0]) == pytest.approx(largest, rel=1e-6)
    # A spring pushes to the side to which the base accelerates.
    assert float(bs.response_spectrum(pulse, hertz, 0.0, side="negative", after=False)[0]) == 0.0


@pytest.mark.parametrize("side", ["positive", "negative"])
def test_both_accelerations_of_an_undamped_oscillator_are_one(side: str) -> None:
    acceleration = over_time(*shaking())
    pseudo, absolute = (
        bs.response_spectrum(acceleration, [1.0, 4.0, 11.0], 0.0, quantity=quantity, side=side)
        for quantity in ("pseudo_acceleration", "absolute_acceleration")
    )
    np.testing.assert_allclose(pseudo, absolute, rtol=1e-12)
    assert (pseudo > 0.0).all()


def shaking() -> tuple[FloatArray, FloatArray]:
    times: FloatArray = np.arange(200.0) * 0.01
    return times, np.random.default_rng(3).normal(size=200)


@pytest.mark.parametrize("uneven", [False, True])
def test_against_an_ode_solver(uneven: bool) -> None:
    times, base = shaking()
    if uneven:
        times = times + 0.003 * np.sin(np.arange(200.0))
        times[0] = 0.0
    omega, ratio = 2.0 * math.pi * 7.3, 0.03
    motion = oscillator(times, base, 7.3, ratio)

    def rates(t: float, y: FloatArray) -> list[float]:
        acceleration = np.interp(t, times, base)
        return [y[1], -acceleration - 2.0 * ratio * omega * y[1] - omega**2 * y[0]]

    solved = solve_ivp(
        rates, (0.0, times[-1]), [0.0, 0.0], t_eval=times, rtol=1e-10, atol=1e-12, max_step=0.002
    )
    scale = np.abs(motion.displacement).max()
    # The solver steps over the kinks of the acceleration, which costs it some digits.
    np.testing.assert_allclose(motion.displacement, solved.y[0], rtol=0, atol=1e-6 * scale)
    np.testing.assert_allclose(motion.velocity, solved.y[1], rtol=0, atol=1e-6 * scale * omega)


def test_quantities_against_fine_samples() -> None:
    times, base = shaking()
    fine = np.linspace(0.0, times[-1], 200_001)
    motion = oscillator(fine, np.interp(fine, times, base), 4.0, 0.05)
    omega = 2.0 * math.pi * 4.0
    total = -2.0 * 0.05 * omega * motion.velocity - omega**2 * motion.displacement
    expected = {
        "pseudo_acceleration": omega**2 * np.abs(motion.displacement).max(),
        "pseudo_velocity": omega * np.abs(motion.displacement).max(),
        "relative_displacement": np.abs(motion.displacement).max(),
        "relative_velocity": np.abs(motion.velocity).max(),
        "absolute_acceleration": np.abs(total).max(),
    }
    for quantity, value in expected.items():
        found = bs.response_spectrum(
            over_time(times, base), [4.0], 0.05, quantity=quantity, after=False
        )
        # The relative velocity has kinks in its rate at the samples, where its peaks may be.
        assert float(found[0]) == pytest.approx(value, rel=1e-5), quantity


def test_a_soft_and_a_stiff_oscillator() -> None:
    """A stiff one feels the base's acceleration, a soft one its displacement."""
    times = np.linspace(0.0, 1.0, 2001)
    bump = np.sin(math.pi * times) ** 2 * np.cos(2.0 * math.pi * times)
    shock = over_time(times, bump)
    stiff = bs.response_spectrum(shock, [400.0], 0.05)
    assert float(stiff[0]) == pytest.approx(np.abs(bump).max(), rel=1e-2)
    assert stiff.attrs["units"] == "m/s^2"


def test_the_floor_spectrum_of_a_run() -> None:
    """A floor that swings with a period of 0.2 s shakes an oscillator of the same frequency."""
    basis = bs.ModalBasis.from_modes(frequency=[5.0], shapes={("P", "dx"): [1.0]})
    start = bs.ModalState(velocity=[1.0])
    run = bs.simulate(bs.Problem(basis, initial=start, duration=20.0, sample=1e-3))
    found = bs.response_spectrum(run.acceleration("P", "dx"), [1.0, 5.0], 0.02)
    resonance = (2.0 * math.pi * 5.0) * 1.0 / (2.0 * 0.02)
    assert float(found[1]) == pytest.approx(resonance, rel=5e-3)


def test_a_number_gives_a_curve_and_a_list_gives_curves() -> None:
    """A step of the base: overshoots 1 + exp(-pi xi / sqrt(1 - xi2)), whatever the frequency."""
    step, hertz, ratios = over_time([0.0, 4.0], [1.0, 1.0]), [1.0, 5.0, 7.0], [0.0, 0.1, 0.3]
    overshoot = [1.0 + math.exp(-math.pi * xi / math.sqrt(1.0 - xi**2)) for xi in ratios]
    curves = bs.response_spectrum(step, hertz, ratios)
    assert curves.dims == ("damping", "frequency")
    assert curves.shape == (3, 3)
    np.testing.assert_array_equal(curves["damping"], ratios)
    np.testing.assert_allclose(curves, np.outer(overshoot, np.ones(3)), rtol=1e-6)
    for xi, curve in zip(ratios, curves, strict=True):
        one = bs.response_spectrum(step, hertz, xi)
        assert (one.dims, one.attrs["damping"]) == (("frequency",), xi)
        np.testing.assert_array_equal(one, curve)
    assert bs.response_spectrum(step, hertz, [0.1]).shape == (1, 3)
    assert bs.response_spectrum(step, hertz, np.float64(0.1)).shape == (3,)


@pytest.mark.parametrize(
    ("options", "key"),
    [
        ({"frequency": [0.0]}, "frequency"),
        ({"damping": 1.0}, "damping"),
        ({"damping": [0.1, -0.1]}, "damping"),
        ({"damping": []}, "damping"),
        ({"damping": [[0.1]]}, "damping"),
        ({"damping": "much"}, "damping"),
        ({"quantity": "pseudo"}, "quantity"),
        ({"side": "left"}, "side"),
        ({"acceleration": over_time([1.0, 0.0], [0.0, 0.0])}, "acceleration"),
    ],
)
def test_refuses(options: dict[str, Any], key: str) -> None:
    given: dict[str, Any] = {
        "acceleration": over_time([0.0, 1.0], [0.0, 1.0]),
        "frequency": [1.0],
        "damping": 0.0,
    }
    with pytest.raises(bs.InputError) as caught:
        bs.response_spectrum(**(given | options))
    assert caught.value.key == key
