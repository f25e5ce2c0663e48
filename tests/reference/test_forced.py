"""Loads that change in time, against closed forms and a recurrence of the literature."""

import numpy as np
import pytest

import bumpstop as bs

from .several.forced import random_forced
from .several.verdict import compare


def oscillator(frequency: float, damping: float = 0.0) -> bs.ModalBasis:
    return bs.ModalBasis.from_modes(
        frequency=[frequency], damping=[damping], shapes={("P", "dx"): [1.0]}
    )


def moved(basis: bs.ModalBasis, time: object, duration: float, **more: object) -> bs.Response:
    push = bs.NodalForce("push", node="P", force=(1.0, 0, 0), time=time)  # type: ignore[arg-type]
    problem = bs.Problem(basis, loads=[push], duration=duration, **more)  # type: ignore[arg-type]
    return bs.simulate(problem)


def test_resonance_grows_with_time() -> None:
    """From rest at its own frequency: ``x = t sin(w t) / (2 w)``."""
    omega = 2.0 * np.pi * 5.0
    response = moved(oscillator(5.0), bs.Harmonic(5.0, cosine=1.0), 40.0)
    times = response.times
    found = response.displacement("P", "dx").to_numpy()
    expected = times * np.sin(omega * times) / (2.0 * omega)
    np.testing.assert_allclose(found, expected, rtol=0, atol=3e-13 * abs(expected).max())


def test_a_beat_is_a_difference_of_cosines() -> None:
    """Beside resonance: ``x = (cos W t - cos w t) / (w^2 - W^2)``."""
    own, driven = 2.0 * np.pi * 5.0, 2.0 * np.pi * 5.01
    response = moved(oscillator(5.0), bs.Harmonic(5.01, cosine=1.0), 40.0)
    times = response.times
    turn, shift = 0.5 * (own + driven), 0.5 * (own - driven)
    expected = 2.0 * np.sin(turn * times) * np.sin(shift * times) / (own**2 - driven**2)
    found = response.displacement("P", "dx").to_numpy()
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * abs(expected).max())


def test_a_ramp_is_followed_with_a_ripple() -> None:
    """``x = (t - sin(w t) / w) / w^2``, then a constant force after a second."""
    omega = 2.0 * np.pi * 1.3
    ramp = bs.TimeTable([0.0, 1.0], [0.0, 1.0], beyond="hold")
    response = moved(oscillator(1.3), ramp, 3.0)
    times = response.times
    after = np.maximum(times - 1.0, 0.0)
    expected = (times - np.sin(omega * times) / omega) / omega**2
    expected -= (after - np.sin(omega * after) / omega) / omega**2
    found = response.displacement("P", "dx").to_numpy()
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-14 / omega**2)
    assert response.history.event_count == 0


def recurrence(omega: float, xi: float, step: float, loads: np.ndarray) -> np.ndarray:
    """Return the displacements of Nigam and Jennings, exact for straight lines.

    N. C. Nigam, P. C. Jennings, Calculation of response spectra from strong-motion earthquake
    records, Bulletin of the Seismological Society of America 59 (1969).
    """
    damped = omega * np.sqrt(1.0 - xi**2)
    decay = np.exp(-xi * omega * step)
    sine, cosine = np.sin(damped * step), np.cos(damped * step)
    x, v = np.zeros(len(loads)), 0.0
    for n in range(len(loads) - 1):
        slope = (loads[n + 1] - loads[n]) / step
        # The particular solution is a + b t.
        b = slope / omega**2
        a = (loads[n] - 2.0 * xi * omega * b) / omega**2
        start, rate = x[n] - a, v - b
        swing = (rate + xi * omega * start) / damped
        x[n + 1] = a + b * step + decay * (start * cosine + swing * sine)
        turning = (swing * damped - xi * omega * start) * cosine
        turning -= (start * damped + xi * omega * swing) * sine
        v = b + decay * turning
    return x


@pytest.mark.parametrize(("frequency", "xi"), [(0.3, 0.05), (2.0, 0.02), (30.0, 0.1)])
def test_an_accelerogram_agrees_with_nigam_and_jennings(frequency: float, xi: float) -> None:
    count, step = 4000, 0.005
    ground = np.random.default_rng(8).normal(size=count).cumsum()
    ground -= np.linspace(ground[0], ground[-1], count)
    table = bs.TimeTable(step * np.arange(count, dtype=np.float64), -ground)
    duration = step * (count - 1)
    push = bs.NodalForce("push", node="P", force=(1.0, 0, 0), time=table)
    problem = bs.Problem(oscillator(frequency, xi), loads=[push], duration=duration, sample=step)
    found = bs.simulate(problem).displacement("P", "dx").to_numpy()
    expected = recurrence(2.0 * np.pi * frequency, xi, step, -ground)
    np.testing.assert_allclose(found, expected, rtol=0, atol=2e-11 * abs(expected).max())


@pytest.mark.parametrize("seed", range(60))
def test_random_problem_under_loads_in_time(seed: int) -> None:
    verdict = compare(random_forced(seed))
    assert verdict.difference is None or verdict.undecidable
    assert verdict.excess < 1.0
