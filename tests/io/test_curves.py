"""Curves of results in NetCDF files, read back equal, and damage that is found."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

import bumpstop as bs
from bumpstop.post.results.contacts import Statistics
from bumpstop.post.results.motion import Section
from bumpstop.post.results.reading import Result, read_result
from bumpstop.post.results.spectra import FloorSpectrum, Spectrum

MOTION = ("velocity", "P", "dx")


@pytest.fixture(scope="module")
def run() -> bs.Response:
    basis = bs.ModalBasis.from_modes(frequency=[2.0], damping=0.02, shapes={("P", "dx"): [1.0]})
    stop = bs.Stop("wall", node="P", normal=(-1, 0, 0), gap=1e-3, stiffness=4e4, damping=20.0)
    load = bs.NodalForce("f", node="P", force=(30.0, 0, 0), time=bs.Harmonic(3.1, sine=1.0))
    return bs.simulate(bs.Problem(basis, laws=[stop], loads=[load], duration=10.0, sample=0.01))


def results() -> list[Result]:
    return [
        Statistics("contact", stop="wall", start=1.0),
        Spectrum("lines", target=MOTION, kind="amplitude", step=1e-2),
        Spectrum("density", target=MOTION, kind="density", step=1e-2, segment=2.0),
        Spectrum("gram", target=MOTION, kind="spectrogram", step=1e-2, segment=1.0),
        Spectrum("envelope", target=MOTION, kind="envelope", step=1e-2),
        FloorSpectrum(
            "floor",
            node="P",
            dof="dx",
            frequencies=np.geomspace(0.5, 20.0, 9).tolist(),
            damping=[0.02, 0.05],
            step=1e-2,
        ),
        Section("section", node="P", dof="dx", period=1.0 / 3.1),
    ]


@pytest.fixture
def file(run: bs.Response, tmp_path: Path) -> tuple[Path, list[Result]]:
    wanted = results()
    run.to_netcdf(tmp_path / "run.nc", results=wanted)
    return tmp_path / "run.nc", wanted


def test_curves_come_back_equal(run: bs.Response, file: tuple[Path, list[Result]]) -> None:
    path, wanted = file
    found = bs.read_curves(path)
    drawn = {each.name: [one.array for one in read_result(each, run).figures] for each in wanted}
    assert list(found) == list(drawn)
    assert sum(map(len, drawn.values())) >= 9
    for name, curves in drawn.items():
        assert len(found[name]) == len(curves)
        for mine, yours in zip(found[name], curves, strict=True):
            xr.testing.assert_identical(mine, yours)
    assert bs.read_netcdf(path).equals(run)
    assert len(bs.read_results(path)) > 10


def test_other_programs_see_them(run: bs.Response, file: tuple[Path, list[Result]]) -> None:
    path, wanted = file
    (own,) = read_result(wanted[2], run).figures
    with xr.open_dataset(path, engine="h5netcdf") as opened:
        (name,) = (
            str(name)
            for name, each in opened.data_vars.items()
            if each.attrs.get("curve_of") == "density"
        )
        np.testing.assert_array_equal(opened[name], own.array)
        np.testing.assert_array_equal(opened[f"{name}_frequency"], own.array["frequency"])
        assert opened[name].attrs["units"] == own.array.attrs["units"]


def test_files_without_curves(run: bs.Response, tmp_path: Path) -> None:
    run.to_netcdf(tmp_path / "run.nc")
    assert bs.read_curves(tmp_path / "run.nc") == {}
    with pytest.raises(bs.InputError, match=r"none\.nc: no such file"):
        bs.read_curves(tmp_path / "none.nc")


def place_of(path: Path, values: np.ndarray) -> int:
    """Return where some numbers begin in a file."""
    place = path.read_bytes().find(np.ascontiguousarray(values).tobytes())
    assert place > 0
    return place


@pytest.mark.parametrize(
    "name", ["time", "modal_velocity", "stop_force", "energy_total", "impact_impulse", "problem"]
)
def test_one_damaged_number_is_found(run: bs.Response, tmp_path: Path, name: str) -> None:
    path = tmp_path / "run.nc"
    # Instants that are told one by one: evenly spaced ones are made anew, not read.
    run.at(run.times[:700] ** 2 / run.times[699]).to_netcdf(path)
    with h5py.File(path) as opened:
        values = opened[name][()]
    largest = int(np.abs(values[:-9].astype(float)).reshape(len(values) - 9, -1)[:, 0].argmax())
    values = values[largest : largest + (8 if values.itemsize == 8 else len(values))]
    content = bytearray(path.read_bytes())
    content[place_of(path, values) + 3] ^= 0x10
    path.write_bytes(content)
    with pytest.raises(bs.InputError, match=rf"run\.nc: {name}: is damaged") as error:
        bs.read_netcdf(path)
    assert "\n" not in str(error.value)


def test_damaged_texts_are_found(run: bs.Response, tmp_path: Path) -> None:
    path = tmp_path / "run.nc"
    run.to_netcdf(path)
    with h5py.File(path, "r+") as opened:
        opened["event_after"][1] = "stuck"
    with pytest.raises(bs.InputError, match=r"run\.nc: event_after: is damaged"):
        bs.read_netcdf(path)


def test_damaged_curves_are_found(run: bs.Response, file: tuple[Path, list[Result]]) -> None:
    path, wanted = file
    (own,) = read_result(wanted[1], run).figures
    content = bytearray(path.read_bytes())
    content[place_of(path, own.array.values[:40]) + 5] ^= 1
    path.write_bytes(content)
    with pytest.raises(bs.InputError, match=r"run\.nc: curve_lines_.*is damaged"):
        bs.read_curves(path)


def test_whatever_byte_is_damaged_nothing_else_is_read(tmp_path: Path) -> None:
    """A file with a damaged byte is refused in one line, or tells what was written."""
    basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    stop = bs.Stop("wall", node="P", normal=(-1, 0, 0), gap=0.1, stiffness=400.0)
    start = bs.ModalState(velocity=[1.0])
    run = bs.simulate(bs.Problem(basis, laws=[stop], initial=start, duration=1.0, sample=0.1))
    run.to_netcdf(tmp_path / "run.nc")
    content = (tmp_path / "run.nc").read_bytes()
    chance = np.random.default_rng(3)
    refused = told = 0
    # The indices of the pieces have no checksums of HDF5's own.
    indices = [at + 36 for at in range(len(content)) if content[at : at + 4] == b"TREE"]
    for place in [*indices, *chance.integers(0, len(content), 150)]:
        damaged = bytearray(content)
        damaged[place] ^= 1 << int(chance.integers(0, 8))
        (tmp_path / "damaged.nc").write_bytes(damaged)
        try:
            again = bs.read_netcdf(tmp_path / "damaged.nc")
        except bs.InputError as error:
            refused += "\n" not in str(error)
            told += 1
        else:
            assert again.equals(run), f"byte {place}"
    assert refused == told
    assert told > 10
