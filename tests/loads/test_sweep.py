"""Sweeps: against SciPy's chirps, and how far straight lines stray."""

from typing import Any

import numpy as np
import pytest
from scipy.signal import chirp

import bumpstop as bs


@pytest.mark.parametrize("spacing", ["linear", "logarithmic"])
@pytest.mark.parametrize("frequencies", [(3.0, 40.0), (40.0, 3.0), (7.0, 7.0)])
def test_a_sweep_is_a_chirp(spacing: str, frequencies: tuple[float, float]) -> None:
    sweep = bs.Sweep(frequencies, duration=4.0, spacing=spacing, amplitude=2.0, phase=0.3)
    times = np.linspace(0.0, 3.999, 5001)
    first, last = frequencies
    turned = -90.0 + np.rad2deg(0.3)  # a cosine to SciPy
    expected = 2.0 * chirp(times, first, 4.0, last, spacing, phi=turned)
    np.testing.assert_allclose(sweep.at(times), expected, atol=1e-10)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize(("spacing", "first"), [("linear", 0.0), ("logarithmic", 0.5)])
def test_straight_lines_stay_within_the_tolerance(
    tolerance: float, spacing: str, first: float
) -> None:
    sweep = bs.Sweep(
        (first, 30.0), duration=2.0, spacing=spacing, amplitude=3.0, start=0.5, tolerance=tolerance
    )
    (table,) = sweep.terms(3.0)
    times = np.linspace(0.0, 2.499, 100_003)
    strayed = np.abs(table.at(times) - sweep.at(times)).max()
    assert 0.3 * tolerance < strayed / 3.0 <= tolerance  # and not for nothing so many lines


def test_nothing_before_and_after() -> None:
    sweep = bs.Sweep((1.0, 5.0), duration=1.0, phase=1.0, start=1.0)
    (table,) = sweep.terms(4.0)
    outside = np.array([0.0, 0.99, 2.01, 4.0])
    assert not sweep.at(outside).any()
    assert not table.at(outside).any()
    (short,) = sweep.terms(1.5)
    assert float(short.times[-1]) == 1.5
    (none,) = sweep.terms(0.5)
    assert not np.any(none.values)


@pytest.mark.parametrize(
    ("options", "key", "what"),
    [
        ({"frequencies": (0.0, 5.0), "spacing": "logarithmic"}, "frequencies", "positive"),
        ({"frequencies": (0.0, 0.0)}, "frequencies", "both be zero"),
        ({"frequencies": (-1.0, 5.0)}, "frequencies", "negative"),
        ({"frequencies": (1.0,)}, "frequencies", "list of 2 numbers"),
        ({"duration": 0.0}, "duration", "positive"),
        ({"spacing": "log"}, "spacing", "logarithmic"),
        ({"tolerance": 1.0}, "tolerance", "less than 1"),
    ],
)
def test_mistakes_are_one_line(options: dict[str, Any], key: str, what: str) -> None:
    said: dict[str, Any] = {"frequencies": (1.0, 2.0), "duration": 1.0} | options
    with pytest.raises(bs.InputError, match=what) as caught:
        bs.Sweep(**said)
    assert caught.value.key == key


def test_too_many_lines_are_refused() -> None:
    sweep = bs.Sweep((1.0, 1e6), duration=100.0)
    with pytest.raises(bs.InputError, match="needs more than 2,000,000 straight lines"):
        sweep.terms(100.0)
