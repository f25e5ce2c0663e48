"""Spectra of signals whose spectra are known."""

import math
from typing import Any

import numpy as np
import pytest
import scipy.signal
import xarray as xr

import bumpstop as bs

RATE = 1000.0
TIMES = np.arange(4000) / RATE


def signal(values: Any, times: Any = TIMES) -> xr.DataArray:
    attrs = {"units": "m", "long_name": "displacement"}
    return xr.DataArray(np.asarray(values), coords={"time": times}, dims="time", attrs=attrs)


TWO_WAVES = signal(
    1.5 + 2.0 * np.cos(2 * np.pi * 25.0 * TIMES + 0.3) + 0.1 * np.sin(2 * np.pi * 60.0 * TIMES)
)


@pytest.mark.parametrize("window", ["boxcar", "hann", "flattop"])
def test_lines_are_as_high_as_the_waves(window: str) -> None:
    found = bs.amplitude_spectrum(TWO_WAVES, window=window)
    assert float(found.sel(frequency=0.0)) == pytest.approx(1.5, rel=1e-9)
    assert float(found.sel(frequency=25.0)) == pytest.approx(2.0, rel=1e-9)
    assert float(found.sel(frequency=60.0)) == pytest.approx(0.1, rel=1e-7)
    assert float(found["phase"].sel(frequency=25.0)) == pytest.approx(0.3, abs=1e-9)
    assert found.attrs["units"] == "m"


def test_what_is_taken_off_first() -> None:
    found = bs.amplitude_spectrum(TWO_WAVES, detrend="constant")
    assert float(found.sel(frequency=0.0)) < 1e-12


def test_density_is_that_of_welch_and_adds_up_to_the_mean_square() -> None:
    noise = np.random.default_rng(1).normal(size=4000)
    found = bs.power_spectral_density(signal(noise), segment=0.5)
    frequency, density = scipy.signal.welch(noise, fs=RATE, nperseg=500)
    np.testing.assert_allclose(found, density, rtol=1e-12)
    np.testing.assert_allclose(found["frequency"], frequency)
    assert float(found.integrate("frequency")) == pytest.approx(noise.var(), rel=0.03)
    assert found.attrs["units"] == "(m)^2/Hz"


def test_the_density_of_a_wave_is_half_its_square() -> None:
    wave = signal(3.0 * np.sin(2 * np.pi * 100.0 * TIMES))
    found = bs.power_spectral_density(wave, segment=1.0)
    assert float(found.sum() * 1.0) == pytest.approx(4.5, rel=1e-9)
    assert float(found["frequency"][int(found.values.argmax())]) == 100.0


def test_a_spectrogram_follows_a_sweep() -> None:
    sweep = signal(np.sin(2 * np.pi * (20.0 * TIMES + 25.0 * TIMES**2)))
    found = bs.spectrogram(sweep, segment=0.25)
    peaks = found["frequency"].values[found.values.argmax(axis=0)]
    np.testing.assert_allclose(peaks, 20.0 + 50.0 * found["time"].values, atol=4.0)
    # Each column adds up to the mean square.
    power = found.sum("frequency") / 0.25
    np.testing.assert_allclose(power, 0.5, rtol=0.02)


def test_a_spectrogram_of_one_segment_is_the_density() -> None:
    noise = signal(np.random.default_rng(2).normal(size=600), TIMES[:600])
    found = bs.spectrogram(noise, segment=0.6, overlap=0.0)
    density = bs.power_spectral_density(noise, segment=0.6, detrend="none")
    np.testing.assert_allclose(found.values[:, 0], density.values, rtol=1e-9)


def test_an_envelope_is_the_modulation() -> None:
    slow = 1.0 + 0.4 * np.sin(2 * np.pi * 0.5 * TIMES)
    found = bs.envelope(signal(slow * np.cos(2 * np.pi * 100.0 * TIMES)))
    np.testing.assert_allclose(found, slow, rtol=1e-9)
    assert found.attrs["units"] == "m"


def test_the_free_decay_of_a_run() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[10.0], shapes={("P", "dx"): [1.0]})
    start = bs.ModalState(velocity=[2.0])
    run = bs.simulate(bs.Problem(basis, initial=start, duration=4.0 - 1e-3, sample=1e-3))
    found = bs.amplitude_spectrum(run.displacement("P", "dx"))
    peak = 2.0 / (2.0 * math.pi * 10.0)
    assert float(found.sel(frequency=10.0)) == pytest.approx(peak, rel=1e-9)


def test_a_map_of_it_can_be_drawn() -> None:
    found = bs.spectrogram(TWO_WAVES, segment=0.5)
    assert bs.plot(found, log="z").data[0].type == "heatmap"


@pytest.mark.parametrize(
    ("call", "key"),
    [
        (lambda: bs.amplitude_spectrum(signal([1.0, 2.0, 4.0], [0.0, 1.0, 3.0])), "signal"),
        (lambda: bs.amplitude_spectrum(TWO_WAVES, window="hahn"), "window"),
        (lambda: bs.amplitude_spectrum(TWO_WAVES, detrend="mean"), "detrend"),
        (lambda: bs.power_spectral_density(TWO_WAVES, segment=10.0), "segment"),
        (lambda: bs.power_spectral_density(TWO_WAVES, overlap=1.0), "overlap"),
        (lambda: bs.spectrogram(TWO_WAVES, segment=1e-4), "segment"),
        (lambda: bs.envelope(TWO_WAVES.expand_dims("node")), "signal"),
    ],
)
def test_refuses(call: Any, key: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        call()
    assert caught.value.key == key
