"""Blows on rigid stops, and the Fourier transform of forces: against closed forms."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from scipy.io import loadmat

import bumpstop as bs

BODY = bs.ModalBasis.from_modes(frequency=[0.0], shapes={("ball", "dy"): [1.0]})
GRAVITY, RETURNED, DURATION = 9.81, 0.5, 3.0
HERTZ = [0.0, 0.7, 3.0, 40.0]


@pytest.fixture(scope="module")
def ball() -> bs.Response:
    """A ball of 1 kg that falls 1 m onto a rigid floor, bounces and comes to rest."""
    floor = bs.RigidStop("floor", node="ball", normal=(0, 1, 0), gap=1.0, restitution=RETURNED)
    weight = bs.NodalForce("weight", node="ball", force=(0, -GRAVITY, 0))
    return bs.simulate(bs.Problem(BODY, laws=[floor], loads=[weight], duration=DURATION))


def blows(count: int) -> tuple[Any, Any]:
    """Return times and impulses of the first blows of the ball."""
    speeds = math.sqrt(2.0 * GRAVITY) * RETURNED ** np.arange(count)
    pauses = np.concatenate([[speeds[0]], 2.0 * speeds[1:]]) / GRAVITY
    return np.cumsum(pauses), (1.0 + RETURNED) * speeds


def test_impulses_are_those_of_the_fall(ball: bs.Response) -> None:
    found = ball.impulses
    times, impulses = blows(12)
    assert found.columns.tolist() == ["time", "stop", "impulse"]
    assert set(found["stop"]) == {"floor"}
    np.testing.assert_allclose(found["time"][:12], times, rtol=1e-12)
    np.testing.assert_allclose(found["impulse"][:12], impulses, rtol=1e-9)
    assert found.attrs["units"] == {"time": "s", "impulse": "N s"}


def test_momentum_is_the_sum_of_impulses_and_weight(ball: bs.Response) -> None:
    """Until the ball is in the air the second time all of the force is one blow."""
    (first, *_), (impulse, *_) = blows(2)
    found = bs.contact_statistics(ball, "floor", end=1.2 * first, blocks=1)
    assert found["mean_force"] == pytest.approx(impulse / (1.2 * first), rel=1e-12)
    assert found["mean_impulse"] == pytest.approx(ball.impulses["impulse"][0], rel=1e-15)
    assert math.isinf(found["largest_force"])


def test_the_spectrum_of_blows_and_rest(ball: bs.Response) -> None:
    times, impulses = blows(30)
    rest = 1.5 * times[0] / 0.5  # t0 (1 + e) / (1 - e)
    found = bs.force_spectrum(ball, "floor", HERTZ)
    for hertz, value in zip(HERTZ, found.values, strict=True):
        turns = 2.0 * math.pi * hertz
        expected = impulses @ np.exp(-1j * turns * times)
        ends = np.exp(-1j * turns * np.array([rest, DURATION]))
        expected += GRAVITY * ((ends[0] - ends[1]) / (1j * turns) if hertz else DURATION - rest)
        assert abs(value - expected) < 2e-5  # the last rebound, 4e-6 m/s, is left out
    assert found.attrs["units"] == "N s"
    parts = [
        bs.force_spectrum(ball, "floor", HERTZ, start=start, end=end)
        for start, end in ((0.0, float(ball.impulses["time"][2])), (ball.impulses["time"][2], None))
    ]
    np.testing.assert_allclose(sum(parts), found, rtol=0, atol=1e-9)


def test_the_spectrum_of_a_half_sine() -> None:
    """A ball thrown at a spring pushes it for half a period."""
    stiffness, speed, gap = 1e4, 0.5, 0.05
    wall = bs.Stop("wall", node="ball", normal=(0, 1, 0), gap=gap, stiffness=stiffness)
    thrown = bs.ModalState(velocity=[-speed])
    run = bs.simulate(bs.Problem(BODY, laws=[wall], initial=thrown, duration=1.0))
    own, since = math.sqrt(stiffness), gap / speed
    turns = 2.0 * math.pi * np.array(HERTZ)
    expected = speed * own * own * (1.0 + np.exp(-1j * turns * math.pi / own))
    expected = expected * np.exp(-1j * turns * since) / (own**2 - turns**2)
    found = bs.force_spectrum(run, "wall", HERTZ)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-10)
    assert run.impulses.empty


def test_files_hold_the_blows(ball: bs.Response, tmp_path: Path) -> None:
    few = ball.at([0.0, 1.0])
    few.export(tmp_path / "run.nc")
    few.export(tmp_path / "run.mat")
    with h5py.File(tmp_path / "run.nc") as file:
        for name in ("time", "impulse"):
            np.testing.assert_array_equal(file[f"blow_{name}"][()], ball.impulses[name])
        assert {bytes(stop) for stop in file["blow_stop"][()]} == {b"floor"}
        assert file["blow_impulse"].attrs["units"] == b"N s"
    found = loadmat(tmp_path / "run.mat", simplify_cells=True)["impulses"]
    np.testing.assert_array_equal(found["impulse"], ball.impulses["impulse"])
    assert bs.read_netcdf(tmp_path / "run.nc").impulses.equals(ball.impulses)


@pytest.mark.parametrize(
    ("options", "key"),
    [({"stop": "x"}, "stop"), ({"end": 9.0}, "end"), ({"frequency": []}, "frequency")],
)
def test_refuses(ball: bs.Response, options: dict[str, Any], key: str) -> None:
    given: dict[str, Any] = {"stop": "floor", "frequency": [1.0]}
    with pytest.raises(bs.InputError) as caught:
        bs.force_spectrum(ball, **(given | options))
    assert caught.value.key == key
