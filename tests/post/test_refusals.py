"""What readings refuse by name, instead of answering with NaN or a traceback."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import bumpstop as bs

TIMES = np.arange(100) * 0.01


def signal(values: Any = None) -> xr.DataArray:
    wave = np.sin(2.0 * np.pi * 5.0 * TIMES) if values is None else values
    return xr.DataArray(wave, coords={"time": TIMES}, dims="time")


GAPPED = signal(np.where(TIMES[5] == TIMES, np.nan, 1.0))
WORDS = signal(np.array(["a"] * 100))


@pytest.fixture(scope="module")
def run() -> bs.Response:
    basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    wall = bs.Stop("w", node="P", normal=(1, 0, 0), gap=0.0, stiffness=1e4)
    start = bs.ModalState(velocity=[1.0])
    return bs.simulate(bs.Problem(basis, laws=[wall], initial=start, duration=2.0))


@pytest.mark.parametrize(
    "read",
    [
        bs.amplitude_spectrum,
        bs.power_spectral_density,
        bs.envelope,
        lambda each: bs.spectrogram(each, segment=0.1),
        lambda each: bs.response_spectrum(each, [1.0]),
    ],
    ids=["amplitude", "density", "envelope", "spectrogram", "response spectrum"],
)
@pytest.mark.parametrize(
    ("given", "what"),
    [
        (GAPPED, "must be finite"),
        (WORDS, "must be numbers"),
        (np.ones(100), "must be"),
        ("words", "must be"),
        (signal()[:1], "two instants or more"),
    ],
    ids=["NaN", "words", "plain array", "text", "one instant"],
)
def test_signals(read: Callable[[Any], Any], given: Any, what: str) -> None:
    with pytest.raises(bs.InputError, match=what):
        read(given)


@pytest.mark.parametrize(
    ("ask", "key"),
    [
        (lambda _: bs.sampled_impacts([0, 1, 2, 3], [0, np.nan, 2, 0]), "force"),
        (lambda _: bs.sampled_impacts([0, 1], ["a", "b"]), "force"),
        (lambda _: bs.sampled_impacts([0, np.nan, 2], [1, 2, 3]), "times"),
        (lambda _: bs.response_spectrum(signal(), [1e8]), "frequency"),
        (lambda run: bs.stroboscopic_section(run, "P", "dx", 1e-300), "period"),
        (lambda run: bs.periodicity(run, 1e-9), "period"),
        (lambda run: bs.wear(run, "w", "archard", [1.0]), "law"),  # type: ignore[arg-type]
        (lambda _: bs.plot(5), "array"),  # type: ignore[arg-type]
        (lambda _: bs.plot(signal(), log="q"), "log"),
    ],
)
def test_values(run: bs.Response, ask: Callable[[bs.Response], Any], key: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        ask(run)
    assert caught.value.key == key


def test_a_speed_may_be_unknown() -> None:
    found = bs.sampled_impacts([0, 1, 2], [0, 1, 0], [np.nan, np.nan, 1.0])
    assert np.isnan(found["closing_speed"][0])


def test_a_damaged_chunk_of_a_store(tmp_path: Path) -> None:
    case = bs.load_case("cases/ball-on-floor/case.toml")
    outputs = {"n": bs.Output(quantity="impact_rate", stop="floor")}
    values = {"stops.floor.restitution": [0.5, 0.6, 0.7, 0.8]}
    store = tmp_path / "study.zarr"
    bs.study(case, values, outputs, store=store, workers=1)
    (chunk, *_) = (file for file in (store / "n" / "c").rglob("*") if file.is_file())
    content = bytearray(chunk.read_bytes())
    content[4:] = bytes(255 - byte for byte in content[4:])
    chunk.write_bytes(content)
    with pytest.raises(bs.InputError, match="is damaged"):
        bs.open_study(store).load()
