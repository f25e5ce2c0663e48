"""Signals that are sampled as they are read, against NumPy and SciPy on the whole signal."""

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.signal

import bumpstop as bs
from bumpstop.post import streams

STEP = 1e-3


@pytest.fixture(scope="module")
def run() -> bs.Response:
    """A body that is shaken against a wall."""
    basis = bs.ModalBasis.from_modes(frequency=[3.0], damping=0.02, shapes={("P", "dx"): [1.0]})
    wall = bs.Stop("wall", node="P", normal=(1, 0, 0), gap=1e-3, stiffness=1e4, damping=5.0)
    load = bs.NodalForce("load", node="P", force=(5.0, 0, 0), time=bs.Harmonic(4.1, cosine=1.0))
    return bs.simulate(bs.Problem(basis, laws=[wall], loads=[load], duration=20.0))


@pytest.fixture(autouse=True)
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Blocks that end within segments."""
    monkeypatch.setattr(streams, "BLOCK", 777)


def test_the_force_of_a_rigid_stop_is_no_signal() -> None:
    """Its blows have no force: means and spectra would be of a part of it."""
    basis = bs.ModalBasis.from_modes(frequency=[0.0], shapes={("P", "dx"): [1.0]})
    wall = bs.RigidStop("wall", node="P", normal=(1, 0, 0), gap=0.1, restitution=0.5)
    thrown = bs.ModalState(velocity=[-0.5])
    run = bs.simulate(bs.Problem(basis, laws=[wall], initial=thrown, duration=1.0))
    with pytest.raises(bs.InputError, match=r"stop: is rigid: its force lacks the blows"):
        bs.Stream(run, "stop_force", "wall", step=1e-3)
    assert len(bs.Stream(run, "gap", "wall", step=1e-3)) == 1001


def test_statistics_are_those_of_the_samples(run: bs.Response) -> None:
    stream = bs.Stream(run, "displacement", "P", "dx", step=STEP, start=1.0, end=19.0)
    times = 1.0 + STEP * np.arange(18_001)
    values = run.sample("displacement", "P", "dx", times=times)
    found = bs.signal_statistics(stream)
    assert (found.count, found.units) == (18_001, "m")
    assert found.mean == pytest.approx(values.mean(), rel=1e-12)
    assert found.standard_deviation == pytest.approx(values.std(), rel=1e-13)
    assert found.rms == pytest.approx(np.sqrt(np.mean(values**2)), rel=1e-13)
    assert (found.minimum, found.maximum) == (values.min(), values.max())
    assert found.time_of_minimum == times[values.argmin()]
    assert found.time_of_maximum == times[values.argmax()]


def test_a_mean_far_from_zero_takes_no_digits() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[0.0, 1.0], shapes={("P", "dx"): [1.0, 1.0]})
    start = bs.ModalState(displacement=[1e8, 1.0])
    far = bs.simulate(bs.Problem(basis, initial=start, duration=10.0))
    found = bs.signal_statistics(bs.Stream(far, "displacement", "P", "dx", step=1e-3, end=9.999))
    # A whole number of periods of a cosine; the far mean leaves eight digits of the samples.
    assert found.standard_deviation == pytest.approx(np.sqrt(0.5), rel=1e-7)


@pytest.mark.parametrize("detrend", ["none", "constant", "linear"])
@pytest.mark.parametrize(
    ("segment", "overlap"), [(0.5, 0.5), (0.777, 0.9), (3.001, 0.0), (None, 0.5)]
)
def test_density_is_that_of_scipy(
    run: bs.Response, segment: float | None, overlap: float, detrend: str
) -> None:
    stream = bs.Stream(run, "velocity", "P", "dx", step=STEP)
    found = bs.power_spectral_density(stream, segment=segment, overlap=overlap, detrend=detrend)
    values = run.sample("velocity", "P", "dx", times=STEP * np.arange(20_001))
    length = 20_001 // 8 if segment is None else round(segment / STEP)
    frequency, density = scipy.signal.welch(
        values,
        fs=1.0 / STEP,
        nperseg=length,
        noverlap=round(overlap * length),
        detrend=False if detrend == "none" else detrend,
    )
    np.testing.assert_allclose(found["frequency"], frequency, rtol=1e-13)
    np.testing.assert_allclose(found, density, rtol=1e-9, atol=1e-15 * density.max())
    assert found.attrs["units"] == "(m/s)^2/Hz"
    assert found.attrs["long_name"] == "power spectral density of velocity of P dx"


def test_other_quantities(run: bs.Response) -> None:
    for quantity, target, units in (
        ("stop_force", "wall", "N"),
        ("gap", "wall", "m"),
        ("modal_displacement", 1, "kg^0.5 m"),
    ):
        stream = bs.Stream(run, quantity, target, step=0.01)
        values = run.sample(quantity, target, times=np.minimum(0.01 * np.arange(2001), 20.0))
        assert bs.signal_statistics(stream).maximum == values.max()
        assert stream.units == units


@pytest.mark.parametrize(
    ("changes", "key"),
    [
        ({"step": 0.0}, "step"),
        ({"step": 0.1, "start": -1.0}, "start"),
        ({"step": 0.1, "end": 21.0}, "end"),
        ({"step": 0.1, "start": 5.0, "end": 5.0}, "end"),
    ],
)
def test_refuses(run: bs.Response, changes: dict[str, Any], key: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        bs.Stream(run, "displacement", "P", "dx", **changes)
    assert caught.value.key == key


def test_refuses_what_is_no_signal(run: bs.Response) -> None:
    with pytest.raises(bs.InputError, match="one mode"):
        bs.Stream(run, "modal_displacement", step=0.1)
    with pytest.raises(bs.InputError, match="quantity"):
        bs.Stream(run, "colour", "P", step=0.1)


PEAK = """
import resource, sys
import bumpstop as bs

def read(samples, path):
    basis = bs.ModalBasis.from_modes(frequency=[3.0], shapes={("P", "dx"): [1.0]})
    thrown = bs.ModalState(velocity=[1.0])
    problem = bs.Problem(basis, initial=thrown, duration=1.0, sample=1.0 / samples)
    run = bs.simulate(problem)
    stream = bs.Stream(run, "displacement", "P", "dx", step=1.0 / samples)
    bs.signal_statistics(stream)
    bs.power_spectral_density(stream, segment=1000.0 / samples)
    run.to_netcdf(path)
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

print(read(1_200_000, sys.argv[1]), read(2_400_000, sys.argv[1]))
"""


def test_memory_does_not_grow_with_the_samples(tmp_path: Path) -> None:
    path = tmp_path / "long.nc"
    told = subprocess.run(
        [sys.executable, "-c", PEAK, str(path)], capture_output=True, text=True, check=True
    )
    few, many = (1024 * int(kilobytes) for kilobytes in told.stdout.split())
    # One column held as a whole would be 10 MB more, and the file has fifteen of them. Both runs
    # are so long that the buffers of the file are as large as they get.
    assert path.stat().st_size > 15 * 8 * 2_400_000
    assert many - few < 8 * 1_200_000
