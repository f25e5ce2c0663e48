"""Random signals: their power against the density, by SciPy's estimates and closed forms."""

from typing import Any, cast

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.signal import coherence, welch
from scipy.stats import kurtosis

import bumpstop as bs

DENSITY = bs.SpectralDensity([2.0, 5.0, 20.0, 40.0], [0.1, 4.0, 4.0, 0.5])


def signal(seed: int = 1, period: float = 200.0, **options: Any) -> bs.RandomSignal:
    return bs.RandomSignal(DENSITY, seed=seed, period=period, **options)


def sampled(noise: bs.RandomSignal, rate: float = 1600.0) -> np.ndarray:
    return noise.at(np.arange(int(noise.period * rate)) / rate)


@pytest.mark.parametrize("interpolation", ["logarithmic", "linear"])
def test_the_integral_of_a_density(interpolation: str) -> None:
    # A slope of -1 on logarithmic axes is a logarithm.
    known, values = [1.0, 2.0, 8.0, 16.0], [3.0, 3.0, 0.75, 6.0]
    density = bs.SpectralDensity(known, values, interpolation=interpolation)
    for upper in (0.5, 1.7, 3.0, 8.0, 11.0, 16.0, 30.0):
        expected, _ = quad(density.at, 0.0, upper, points=known, limit=200, epsabs=1e-13)
        assert density.variance_below(np.array([upper]))[0] == pytest.approx(expected, rel=1e-9)
    assert density.at(np.array([0.99, 2.0, 16.1])).tolist() == pytest.approx([0.0, 3.0, 0.0])


@pytest.mark.parametrize("seed", [0, 7, 123456789])
def test_its_power_is_that_of_the_density(seed: int) -> None:
    """Welch's estimate over n segments has a relative standard error of 1 / sqrt(n) at most."""
    values = sampled(signal(seed))
    frequencies, power = welch(values, 1600.0, nperseg=6400)
    inside = (frequencies > 6.0) & (frequencies < 19.0)  # where the density is level
    segments = len(values) / 6400
    ratio = power[inside] / 4.0
    assert abs(ratio - 1.0).max() < 4.5 / np.sqrt(segments)
    assert abs(ratio.mean() - 1.0) < 3.0 / np.sqrt(segments * np.count_nonzero(inside) / 2.0)
    above = frequencies > 45.0
    # The lines' own harmonics: 1 % in amplitude at twenty lines a period.
    assert power[above].max() < 2e-4 * 4.0


def test_its_rms_is_that_of_the_density_whatever_the_seed() -> None:
    for seed in range(3):
        rms = np.sqrt(np.mean(sampled(signal(seed, period=20.0), rate=16000.0) ** 2))
        # Above the band the lines have a hundred thousandth of the power.
        assert rms == pytest.approx(DENSITY.rms, rel=2e-5)


def test_it_is_normal_and_stationary() -> None:
    values = sampled(signal())
    # About 200 s times 20 Hz of bandwidth: 8000 independent values.
    assert abs(kurtosis(values)) < 4.0 * np.sqrt(24.0 / 8000.0)
    blocks = values.reshape(20, -1).var(axis=1) / DENSITY.rms**2
    assert abs(blocks - 1.0).max() < 4.0 * np.sqrt(2.0 / 400.0)


def test_a_seed_gives_the_same_bits_and_another_one_others() -> None:
    one, again, other = (signal(seed).samples[1] for seed in (5, 5, 6))
    assert one.tobytes() == again.tobytes()
    assert abs(np.corrcoef(one, other)[0, 1]) < 0.05


def test_streams_of_a_seed_are_independent() -> None:
    one, other = sampled(signal()), sampled(signal(stream=1))
    _, found = coherence(one, other, 1600.0, nperseg=6400)
    inside = slice(24, 76)
    # Independent signals: coherence 1 / n on average, n = 50 segments that overlap by half.
    assert found[inside].mean() < 3.0 / 50.0


def test_it_repeats_itself_after_its_period() -> None:
    (table,) = signal(period=10.0).terms(25.0)
    times = np.linspace(0.0, 4.99, 500)
    for later in (10.0, 20.0):
        np.testing.assert_allclose(table.at(times + later), table.at(times), atol=1e-9)
    assert float(table.times[-1]) >= 25.0


def test_an_oscillator_under_it() -> None:
    """Second period: the steady state, whose variance is the integral of S |H|^2."""
    basis = bs.ModalBasis.from_modes(frequency=[8.0], damping=0.05, shapes={("P", "dx"): [1.0]})
    noise = signal(period=20.0)
    push = bs.NodalForce("noise", node="P", force=(1, 0, 0), time=noise)
    response = bs.simulate(bs.Problem(basis, loads=[push], duration=40.0))
    motion = response.sample("displacement", "P", "dx", times=np.linspace(20.0, 40.0, 16001))
    omega = 2 * np.pi * 8.0

    def answer(f: float) -> float:
        w = 2 * np.pi * f
        return float(DENSITY.at(np.array([f]))[0]) / abs(omega**2 - w**2 + 0.1j * omega * w) ** 2

    expected, _ = quad(answer, 2.0, 40.0, points=[5.0, 8.0, 20.0], limit=200)
    assert np.mean(motion**2) == pytest.approx(expected, rel=0.02)  # twenty waves in the peak


@pytest.mark.parametrize(
    ("make", "key", "what"),
    [
        (lambda: bs.SpectralDensity([1.0], [1.0]), "values", "two frequencies or more"),
        (lambda: bs.SpectralDensity([1.0, 2.0], [1.0]), "values", "one value for each"),
        (lambda: bs.SpectralDensity([2.0, 1.0], [1.0, 1.0]), "frequencies", "must ascend"),
        (lambda: bs.SpectralDensity([-1.0, 1.0], [1.0, 1.0]), "frequencies", "negative"),
        (lambda: bs.SpectralDensity([1.0, 2.0], [1.0, -1.0]), "values", "negative"),
        (lambda: bs.SpectralDensity([0.0, 2.0], [1.0, 1.0]), "values", "linear"),
        (lambda: bs.SpectralDensity([1.0, 2.0], [0.0, 0.0]), "values", "all be zero"),
        (lambda: signal(seed=-1), "seed", "0 or more"),
        (lambda: signal(period=0.1), "period", "fewer than 10 waves"),
        (lambda: signal(period=1e5), "period", "samples, more than"),
        (lambda: bs.RandomSignal(cast(Any, 3.0), seed=1, period=1.0), "density", "SpectralDensity"),
    ],
)
def test_mistakes_are_one_line(make: Any, key: str, what: str) -> None:
    with pytest.raises(bs.InputError, match=what) as caught:
        make()
    assert caught.value.key == key
