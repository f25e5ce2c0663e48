"""Runs of full models read back from NetCDF files: equal, to the bit, to those written."""

from __future__ import annotations

import contextlib
import io
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pandas as pd
import pytest
import xarray as xr

import bumpstop as bs
from bumpstop import full
from bumpstop.io import netcdf, statement
from bumpstop.modal import full as full_model

STEEL = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
METHODS: dict[str, dict[str, Any]] = {
    "newmark": {"dt": 1e-4},
    "hht": {"dt": 1e-4, "alpha": -0.1},
    "generalized_alpha": {"dt": 1e-4},
    "central_difference": {"dt": 2e-7},
}


def cantilever(elements: int = 3) -> bs.Structure:
    beam = bs.Beam(
        "AB", nodes=("A", "B"), elements=elements, material=STEEL,
        section=bs.Rectangle(height=0.02, width=0.01),
    )  # fmt: skip
    return bs.Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
        beams=[beam],
        supports=[bs.Support(nodes="A", fixed=("dx", "dy", "dz", "drx", "dry", "drz"))],
    )


def shaken(basis: bs.ModalBasis, frame: str = "relative", duration: float = 0.02) -> bs.Problem:
    """A cantilever under its weight whose base shakes it against a rubbing stop and a spring."""
    laws: list[Any] = [
        bs.Stop(
            "tip", node="B", normal=(0, 0, 1), gap=1e-4, stiffness=1e5, damping=5.0,
            friction=0.3, sliding={("B", "dy"): 1.0}, tangential_stiffness=1e4,
        ),
        bs.SpringLaw("side", node="B", direction=(0, 1, 0), stiffness=(0.0, 2e4), breaks=(0.0,)),
    ]  # fmt: skip
    loads: list[Any] = [
        bs.Gravity("weight", acceleration=(0, 0, -9.81)),
        bs.BaseMotion(acceleration=(0, 0, 60.0), time=bs.Harmonic(25.0, sine=1.0), frame=frame),
        bs.NodalForce("push", node="B", force=(0, 3.0, 0), time=bs.Harmonic(40.0, sine=1.0)),
    ]
    return bs.Problem(
        basis, laws=laws, loads=loads, duration=duration, sample=duration / 50.0,
        gauges=[bs.Gauge("strain", beam="AB", at=0.4, fibre=(0.007, 0.0))],
        outputs=[("AB.1", "dz")],
    )  # fmt: skip


def run_of(method: str, frame: str = "relative", structure: Any = None) -> bs.Response:
    mass = "lumped" if method == "central_difference" else "consistent"
    damping = bs.RayleighDamping(alpha=2.0, beta=1e-7)
    model = bs.FullModel.from_structure(structure or cantilever(), damping=damping, mass=mass)
    return bs.simulate(shaken(model, frame), method, **METHODS[method])


def read_again(response: bs.Response, folder: Path) -> bs.Response:
    response.to_netcdf(folder / "response.nc")
    return bs.read_netcdf(folder / "response.nc")


def assert_equal(again: bs.Response, response: bs.Response) -> None:
    """Assert, number by number and without `Response.equals`, that two runs tell the same."""
    assert np.array_equal(again.times, response.times)
    for derivative in range(3):
        assert np.array_equal(again.motion(derivative), response.motion(derivative))
    for law in response.problem.laws:
        for quantity in ("stop_force", "gap", "friction_force", "state"):
            found, expected = (run.sample(quantity, law.name) for run in (again, response))
            assert np.array_equal(found, expected), (law.name, quantity)
    pd.testing.assert_frame_equal(again.impacts, response.impacts, check_exact=True)
    pd.testing.assert_frame_equal(again.events, response.events, check_exact=True)
    xr.testing.assert_identical(again.energy, response.energy)
    for name in ("method", "method_reason", "steps", "options", "energy_residual", "event_count"):
        assert getattr(again, name) == getattr(response, name), name
    assert again.equals(response)
    assert response.equals(again)


@pytest.mark.parametrize("frame", ["relative", "absolute"])
@pytest.mark.parametrize("method", METHODS)
def test_what_is_read_equals_what_was_written(method: str, frame: str, tmp_path: Path) -> None:
    response = run_of(method, frame)
    assert len(response.impacts) > 0
    again = read_again(response, tmp_path)
    assert_equal(again, response)
    # A dof is a coordinate itself: no sum over modes rounds otherwise.
    for node, dof in (("B", "dz"), ("AB.1", "dy")):
        for quantity in ("displacement", "velocity", "acceleration"):
            expected = response.sample(quantity, node, dof)
            assert np.array_equal(again.sample(quantity, node, dof), expected)
    expected = response.sample("gauge", "strain")
    size = 1e-13 * np.abs(expected).max()
    np.testing.assert_allclose(again.sample("gauge", "strain"), expected, rtol=0, atol=size)
    assert_equal(bs.simulate(again.problem, method, **METHODS[method]), response)


@pytest.mark.parametrize("method", METHODS)
def test_runs_that_kept_a_few_dofs_are_read(
    method: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = run_of(method)
    monkeypatch.setattr(full, "KEPT", 0)
    part = run_of(method)
    assert part.kept is not None
    again = read_again(part, tmp_path)
    assert again.kept is not None
    assert np.array_equal(again.kept, part.kept)
    assert_equal(again, part)
    for target in (("B", "dz"), ("AB.1", "dz")):
        found = again.sample("displacement", *target)
        assert np.array_equal(found, whole.sample("displacement", *target))
    with pytest.raises(bs.InputError, match="was not kept"):
        again.sample("displacement", "AB.1", "drx")
    assert not again.equals(whole)
    assert not whole.equals(again)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("most", [0, 2**30], ids=["few", "all"])
def test_between_instants_the_run_is_repeated(
    method: str, most: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To the bit, of all dofs or of the few that were kept; no other dofs pass for these."""
    monkeypatch.setattr(full, "KEPT", most)
    response = run_of(method)
    again = read_again(response, tmp_path)
    times = np.random.default_rng(3).uniform(0.0, response.problem.duration, 40)
    for target in (("displacement", "B", "dz"), ("stop_force", "tip"), ("gauge", "strain")):
        found = again.sample(*target, times=times)
        assert np.array_equal(found, response.sample(*target, times=times))
    if most == 0:
        other = read_again(response, tmp_path)
        monkeypatch.setattr(full, "KEPT", 2**30)
        with pytest.raises(bs.InputError, match="it keeps the motion of other dofs"):
            other.sample("stop_force", "tip", times=times)


def test_the_matrices_come_back_to_the_bit(tmp_path: Path) -> None:
    response = run_of("newmark")
    written, read = response.problem.basis, read_again(response, tmp_path).problem.basis
    assert isinstance(written, bs.FullModel)
    assert isinstance(read, bs.FullModel)
    for mine, yours in zip(read.matrices, written.matrices, strict=True):
        assert mine.shape == yours.shape
        for one, other in zip(mine.arrays, yours.arrays, strict=True):
            assert one.dtype == other.dtype
            assert np.array_equal(one, other)


def test_shapes_too_many_for_plain_arrays_come_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(full_model, "MOST_DENSE", 1)
    response = run_of("hht")
    assert not isinstance(response.problem.basis.shapes, np.ndarray)
    again = read_again(response, tmp_path)
    assert_equal(again, response)
    basis = again.problem.basis
    assert (basis.shapes != response.problem.basis.shapes).nnz == 0
    with h5py.File(tmp_path / "response.nc") as file:
        nodes = [name.decode() for name in file["node"][:]]
        dofs = [name.decode() for name in file["dof"][:]]
        moved = file["displacement"][:, nodes.index("B"), dofs.index("dz")]
    assert np.array_equal(moved, response.sample("displacement", "B", "dz"))


def imported(structure: bs.Structure) -> bs.Matrices:
    """Return the matrices of a structure, as another program would give them."""
    held = [dof for row, dof in enumerate(structure.dofs) if row not in structure.free]
    return bs.Matrices(
        stiffness=structure.stiffness, mass=structure.mass, dofs=structure.dofs, fixed=held,
        positions={node: structure.position(node) for node, _ in structure.dofs},
    )  # fmt: skip


@pytest.mark.parametrize("reduced", [False, True])
def test_models_of_imported_matrices_are_read(reduced: bool, tmp_path: Path) -> None:
    matrices = imported(cantilever())
    stop = bs.Stop("tip", node="B", normal=(0, 0, 1), gap=1e-4, stiffness=1e5)
    weight = bs.Gravity("weight", acceleration=(0, 0, -9.81))
    basis = (
        bs.ModalBasis.from_structure(matrices, modes=4)
        if reduced
        else bs.FullModel.from_structure(matrices)
    )
    problem = bs.Problem(basis, laws=[stop], loads=[weight], duration=0.02, sample=1e-3)
    response = bs.simulate(problem, "newmark", dt=1e-4)
    assert len(response.impacts) > 0
    again = read_again(response, tmp_path)
    assert_equal(again, response)
    assert_equal(bs.simulate(again.problem, "newmark", dt=1e-4), response)


def test_section_forces_are_recovered_from_a_file(tmp_path: Path) -> None:
    response = run_of("newmark")
    found, expected = (
        bs.recovery(run).section_forces("AB", at=0.2)
        for run in (read_again(response, tmp_path), response)
    )
    xr.testing.assert_identical(found, expected)


def test_xarray_finds_the_independent_dofs(tmp_path: Path) -> None:
    response = run_of("newmark")
    response.to_netcdf(tmp_path / "response.nc")
    with xr.open_dataset(tmp_path / "response.nc", engine="h5netcdf") as file:
        tip = file["independent_velocity"].sel(independent_dof="B dz")
        np.testing.assert_array_equal(tip, response.sample("velocity", "B", "dz"))
        assert file["independent_dof_number"].values.tolist() == list(range(1, 19))


def test_long_files_are_written_and_read_in_blocks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(netcdf, "MOST_NUMBERS", 500)
    monkeypatch.setattr("bumpstop.io.columns.HELD", 100)
    response = run_of("newmark")
    assert_equal(read_again(response, tmp_path), response)


def test_huge_models_are_left_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(netcdf, "MOST_ENTRIES", 100)
    with pytest.raises(bs.InputError, match=r"response\.nc: holds no problem \(written by 0"):
        read_again(run_of("newmark"), tmp_path)


@pytest.fixture(scope="module")
def good(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("good") / "good.nc"
    run_of("newmark").to_netcdf(path)
    return path


@pytest.mark.parametrize("numbers", [[1, 1], [0, 2], [2, 40]])
def test_dofs_that_the_model_has_not_are_refused(
    numbers: list[int], good: Path, tmp_path: Path
) -> None:
    (tmp_path / "bad.nc").write_bytes(good.read_bytes())
    with h5py.File(tmp_path / "bad.nc", "r+") as file:
        known = file["independent_dof_number"][:]
        known[:2] = numbers
        file["independent_dof_number"][:] = known
    with pytest.raises(bs.InputError, match=r"bad\.nc: independent_dof_number: are not those"):
        bs.read_netcdf(tmp_path / "bad.nc")


def test_sparse_arrays_that_point_beside_themselves_are_refused() -> None:
    from scipy.sparse import csr_array

    content = statement.packed(csr_array(np.eye(3)))
    arrays = dict(np.load(io.BytesIO(content)))
    assert (statement.unpacked(content) != csr_array(np.eye(3))).nnz == 0
    arrays["array_1"][2] = 3  # a fourth column
    damaged = io.BytesIO()
    np.savez(damaged, allow_pickle=False, **arrays)
    with pytest.raises(ValueError, match="indices must be < 3"):
        statement.unpacked(damaged.getvalue())


def test_a_damaged_file_is_refused_in_a_line(good: Path, tmp_path: Path) -> None:
    content = bytearray(good.read_bytes())
    with h5py.File(good) as file:
        for name in ("independent_velocity", "problem"):
            place = file[name].id.get_chunk_info(0).byte_offset
            damaged = content.copy()
            damaged[place + 100] ^= 1
            (tmp_path / "damaged.nc").write_bytes(damaged)
            with pytest.raises(bs.InputError, match=f"{name}: is damaged") as caught:
                bs.read_netcdf(tmp_path / "damaged.nc")
            assert "\n" not in str(caught.value)


def test_a_file_with_flipped_bytes_is_read_or_refused(good: Path, tmp_path: Path) -> None:
    """No other error than that of a file that cannot be used."""
    content = good.read_bytes()
    chance = np.random.default_rng(0)
    for _ in range(40):
        damaged = bytearray(content)
        for place in chance.integers(0, len(content), 20):
            damaged[place] ^= int(chance.integers(1, 256))
        (tmp_path / "damaged.nc").write_bytes(damaged)
        with contextlib.suppress(bs.BumpstopError):
            bs.read_netcdf(tmp_path / "damaged.nc")


def test_large_models_play_in_vtk_as_small_ones_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run_of("newmark", "absolute").export(tmp_path / "dense.vtkhdf")
    monkeypatch.setattr(full_model, "MOST_DENSE", 0)
    run_of("newmark", "absolute").export(tmp_path / "sparse.vtkhdf")
    with (
        h5py.File(tmp_path / "dense.vtkhdf") as dense,
        h5py.File(tmp_path / "sparse.vtkhdf") as own,
    ):
        for name in ("displacement", "velocity", "contact_force"):
            expected, found = (file["VTKHDF/PointData"][name][:] for file in (dense, own))
            assert np.abs(expected).max() > 0.0
            np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-12 * abs(expected).max())
