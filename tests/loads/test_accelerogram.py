"""Accelerograms that meet a response spectrum: their own spectrum by SciPy, and their drift."""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson
from scipy.signal import StateSpace, lsim

import bumpstop as bs

TARGET = ([1.0, 2.5, 9.0, 33.0], [2.0, 4.0, 4.0, 1.5])


@pytest.fixture(scope="module")
def quake() -> bs.Accelerogram:
    return bs.Accelerogram(*TARGET, damping=0.05, duration=15.0, seed=2)


def test_its_spectrum_meets_the_target(quake: bs.Accelerogram) -> None:
    (table,) = quake.terms(20.0)
    times, values = np.asarray(table.times), np.asarray(table.values)
    frequencies, own = quake.spectrum
    assert quake.deviation == pytest.approx(abs(own / quake.target(frequencies) - 1.0).max())
    assert quake.deviation < 0.1
    for number in range(0, len(frequencies), 20):
        omega = 2 * np.pi * frequencies[number]
        oscillator = StateSpace([[0, 1], [-(omega**2), -0.1 * omega]], [[0], [-1]], [[1, 0]], [[0]])
        _, moved, _ = lsim(oscillator, values, times)  # with straight lines between samples
        assert own[number] == pytest.approx(omega**2 * abs(moved).max(), rel=1e-6)


def test_the_base_comes_to_rest(quake: bs.Accelerogram) -> None:
    times = np.linspace(0.0, 15.0, 300_001)
    values = quake.at(times)
    velocity = cumulative_simpson(values, x=times, initial=0.0)
    displacement = cumulative_simpson(velocity, x=times, initial=0.0)
    assert abs(velocity[-1]) < 1e-3 * abs(velocity).max()
    assert abs(displacement[-1]) < 1e-3 * abs(displacement).max()
    assert quake.at(np.array([-1.0, 15.5])).tolist() == [0.0, 0.0]


def test_it_rises_and_decays(quake: bs.Accelerogram) -> None:
    times = np.linspace(0.0, 15.0, 3001)
    rms = [np.std(quake.at(times[part])) for part in (times < 0.5, abs(times - 6) < 3, times > 14)]
    assert rms[0] < 0.1 * rms[1]
    assert rms[2] < 0.2 * rms[1]


def test_a_seed_gives_the_same_bits(quake: bs.Accelerogram) -> None:
    again = bs.Accelerogram(*TARGET, damping=0.05, duration=15.0, seed=2)
    times = np.linspace(0.0, 15.0, 999)
    assert again.at(times).tobytes() == quake.at(times).tobytes()


def test_what_is_not_met_is_told() -> None:
    """Four times as much at one frequency as at its neighbours: no motion does that."""
    spiky = [1.0, 4.0, 4.2, 4.4, 20.0], [2.0, 2.0, 8.0, 2.0, 2.0]
    quake = bs.Accelerogram(*spiky, damping=0.2, duration=10.0, seed=1)
    (line,) = quake.remarks
    assert f"by up to {100 * quake.deviation:.3g} %" in line
    assert "\n" not in line
    basis = bs.ModalBasis.from_modes(frequency=[3.0], shapes={("P", "dx"): [1.0]})
    push = bs.NodalForce("push", node="P", force=(1, 0, 0), time=quake)
    assert bs.Problem(basis, loads=[push], duration=1.0).remarks == (f"push: {line}",)


@pytest.mark.parametrize(
    ("options", "key", "what"),
    [
        ({"frequencies": [0.0, 1.0], "values": [1.0, 1.0]}, "frequencies", "positive"),
        ({"values": [1.0]}, "values", "one value for each"),
        ({"values": [1.0, 1.0, -1.0, 1.0]}, "values", "positive"),
        ({"damping": 1.0}, "damping", "below 1"),
        ({"rise": 10.0, "decay": 6.0}, "rise", "fit into the duration"),
        ({"duration": 1.0}, "duration", "two periods of the lowest"),
        ({"duration": 1e6}, "duration", "samples, more than"),
    ],
)
def test_mistakes_are_one_line(options: dict[str, Any], key: str, what: str) -> None:
    said: dict[str, Any] = {
        "frequencies": TARGET[0],
        "values": TARGET[1],
        "damping": 0.05,
        "duration": 15.0,
        "seed": 1,
    }
    with pytest.raises(bs.InputError, match=what) as caught:
        bs.Accelerogram(**said | options)
    assert caught.value.key == key
