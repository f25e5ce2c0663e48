import datetime as dt
import math
import os
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

import bumpstop as bs
from bumpstop.arguments import FloatArray

from ..hinged_beam import SWING, end_stop, hinged_modes


def assert_same(found: xr.DataArray, expected: FloatArray) -> None:
    """Assert that a sum over modes is that of the core, which sums in another order."""
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-13 * np.abs(expected).max())


@pytest.fixture(scope="module")
def thrown_beam() -> bs.Response:
    """The beam of SDNL32 with 4 elements, thrown against its stop."""
    problem = bs.Problem(
        hinged_modes(elements=4, modes=3),
        laws=[end_stop(18e3)],
        initial=SWING,
        duration=0.02,
        sample=1e-4,
        gauges=[
            bs.Gauge("strain", beam="AB", at=0.462, fibre=(0.007, 0.0)),
            bs.Gauge("below", beam="AB", at=0.2, fibre=(-0.007, 0.0)),
        ],
        outputs=[("AB@0.462 m", "drz")],
    )
    return bs.simulate(problem, method="central_difference", dt=1e-5)


@pytest.fixture
def path(tmp_path: Path, thrown_beam: bs.Response) -> Path:
    thrown_beam.to_netcdf(tmp_path / "response.nc", title="A beam", case="sdnl32", variant="soft")
    return tmp_path / "response.nc"


def test_xarray_finds_values_and_units(path: Path, thrown_beam: bs.Response) -> None:
    with xr.open_dataset(path, engine="h5netcdf") as file:
        np.testing.assert_array_equal(file["time"], thrown_beam.times)
        assert file["time"].attrs["units"] == "s"
        tip = file["displacement_B_dy"]
        assert_same(tip, thrown_beam.sample("displacement", "B", "dy"))
        assert tip.attrs["units"] == "m"
        force = file["stop_force"].sel(stop="spring")
        np.testing.assert_array_equal(force, thrown_beam.sample("stop_force", "spring"))
        assert force.attrs["units"] == "N"
        gap = file["gap"].sel(stop="spring")
        np.testing.assert_array_equal(gap, thrown_beam.sample("gap", "spring"))
        np.testing.assert_allclose(gap, tip, atol=1e-15)  # the normal is +y, without clearance
        assert gap.attrs["units"] == "m"
        for gauge in ("strain", "below"):
            strain = file["strain"].sel(gauge=gauge)
            assert_same(strain, thrown_beam.sample("gauge", gauge))
            assert np.abs(strain).max() > 1e-5
            assert strain.attrs["units"] == "1"
        np.testing.assert_array_equal(file["modal_velocity"], thrown_beam.motion(1))
        np.testing.assert_array_equal(file["mode"], [1, 2, 3])


def test_nodes_move_in_space(path: Path, thrown_beam: bs.Response) -> None:
    with xr.open_dataset(path, engine="h5netcdf") as file:
        assert file["displacement"].dims == ("time", "node", "dof")
        assert file["dof"].values.tolist() == ["dy"]
        structure = thrown_beam.problem.basis.structure
        assert structure is not None
        for node in structure.mesh.names:
            found = file["displacement"].sel(node=node, dof="dy")
            expected = thrown_beam.sample("displacement", node, "dy")
            np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-18)
        assert file["displacement"].sel(node="B").coords["x"].item() == 0.783
        assert file["x"].attrs["units"] == "m"


def test_outputs_between_nodes_have_plain_names(path: Path, thrown_beam: bs.Response) -> None:
    with xr.open_dataset(path, engine="h5netcdf") as file:
        turning = file["velocity_AB_0_462_m_drz"]
        assert turning.attrs["units"] == "rad/s"
        assert turning.attrs["node"] == "AB@0.462 m"
        expected = thrown_beam.sample("velocity", "AB@0.462 m", "drz")
        assert_same(turning, expected)


def test_tables(path: Path, thrown_beam: bs.Response) -> None:
    impacts, events = thrown_beam.impacts, thrown_beam.events
    with xr.open_dataset(path, engine="h5netcdf") as file:
        assert file["impact_stop"].values.tolist() == impacts["stop"].tolist()
        for column in impacts.columns[1:]:
            np.testing.assert_array_equal(file[f"impact_{column}"], impacts[column])
        assert file["impact_impulse"].attrs["units"] == "N s"
        for column in events.columns:
            assert file[f"event_{column}"].values.tolist() == events[column].tolist()
        assert len(impacts) == file.sizes["impact"] > 0


def test_energies(path: Path, thrown_beam: bs.Response) -> None:
    with xr.open_dataset(path, engine="h5netcdf") as file:
        for name, values in thrown_beam.energy_terms().items():
            np.testing.assert_array_equal(file[f"energy_{name}"], values)
            assert file[f"energy_{name}"].attrs["units"] == "J"
        shares = file["energy_stored_in_stop"].sel(stop="spring")
        np.testing.assert_array_equal(shares, file["energy_stored"])


def test_the_file_says_where_it_comes_from(path: Path, thrown_beam: bs.Response) -> None:
    with xr.open_dataset(path, engine="h5netcdf") as file:
        told = file.attrs
    assert told["Conventions"] == "CF-1.11"
    assert (told["title"], told["case"], told["variant"]) == ("A beam", "sdnl32", "soft")
    assert told["bumpstop_version"] == bs.__version__
    assert told["source"] == f"bumpstop {bs.__version__}"
    assert (told["method"], told["method_dt"]) == ("central_difference", 1e-5)
    assert told["steps"] == 2000
    assert "missed_penetration" not in told
    assert told["relative_energy_residual"] == thrown_beam.energy_residual
    assert not told.keys() & file.variables.keys()
    age = dt.datetime.now(dt.UTC) - dt.datetime.fromisoformat(told["date_created"])
    assert dt.timedelta(seconds=-1) < age < dt.timedelta(minutes=5)


def test_the_exact_method_leaves_its_certificate(tmp_path: Path, thrown_beam: bs.Response) -> None:
    response = bs.simulate(thrown_beam.problem)
    response.to_netcdf(tmp_path / "exact.nc")
    with xr.open_dataset(tmp_path / "exact.nc", engine="h5netcdf") as file:
        assert file.attrs["certified_steps"] == response.steps
        assert file.attrs["missed_penetration"] == response.missed_penetration
        assert file.attrs["motion_error"] == response.motion_error
    assert response.missed_penetration is not None
    assert 0.0 < response.missed_penetration < 1e-14


def test_h5py_finds_dimensions_tied_to_scales(path: Path) -> None:
    with h5py.File(path) as file:
        displacement = file["displacement"]
        scales = [displacement.dims[axis][0].name for axis in range(3)]
        assert scales == ["/time", "/node", "/dof"]
        assert file["time"].is_scale
        assert file["displacement_B_dy"].attrs["units"] == b"m"
        assert displacement.dtype == np.float64
        assert file["stop"].asstr()[()].tolist() == ["spring"]


def test_a_problem_without_stops_and_structure(tmp_path: Path) -> None:
    basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    start = bs.ModalState(velocity=[1.0])
    problem = bs.Problem(basis, initial=start, duration=1.0, outputs=[("P", "dx")])
    response = bs.simulate(problem, method="central_difference", dt=1e-3)
    response.at([0.25, 0.5]).to_netcdf(tmp_path / "free.nc")
    with xr.open_dataset(tmp_path / "free.nc", engine="h5netcdf") as file:
        assert file.sizes["impact"] == file.sizes["event"] == 0
        assert "stop" not in file.dims
        assert "title" not in file.attrs
        found = file["displacement_P_dx"]
        assert found[0] == pytest.approx(1.0 / (2.0 * math.pi), rel=1e-5)
        assert found["time"].values.tolist() == [0.25, 0.5]


def test_vectors_of_the_user_have_their_own_names(tmp_path: Path) -> None:
    modes = hinged_modes(elements=4, modes=3)
    assert modes.structure is not None
    mixed = modes.shapes @ [[1, 1, 0], [1, -1, 0], [0, 0, 1]]
    basis = bs.ModalBasis.from_vectors(modes.structure, mixed, labels=["sum", "difference", "m3"])
    state = bs.ModalState(velocity=[0.0, 0.5, 0.0])
    response = bs.simulate(bs.Problem(basis, initial=state, duration=0.01, sample=1e-3))
    response.to_netcdf(tmp_path / "response.nc")
    with xr.open_dataset(tmp_path / "response.nc", engine="h5netcdf") as file:
        assert file["vector"].values.tolist() == ["sum", "difference", "m3"]
        speed = file["modal_velocity"]
        assert speed.dims == ("time", "vector")
        assert "units" not in speed.attrs
        np.testing.assert_allclose(speed[0], [0.0, 0.5, 0.0], atol=1e-14)
        assert file["frequency"].dims == ("mode",)


def test_a_file_that_was_there_is_replaced(tmp_path: Path, thrown_beam: bs.Response) -> None:
    (tmp_path / "response.nc").write_text("old")
    thrown_beam.to_netcdf(tmp_path / "response.nc")
    assert h5py.is_hdf5(tmp_path / "response.nc")
    assert os.listdir(tmp_path) == ["response.nc"]  # noqa: PTH208  # hidden files count too


@pytest.mark.parametrize(
    ("name", "what"),
    [
        ("missing/response.nc", "No such file"),
        ("file/response.nc", "Not a directory"),
        ("", "folder"),
    ],
)
def test_places_that_cannot_be_written(
    tmp_path: Path, thrown_beam: bs.Response, name: str, what: str
) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(bs.InputError, match=what) as caught:
        thrown_beam.to_netcdf(tmp_path / name)
    assert caught.value.file == str(tmp_path / name)
    assert [found.name for found in tmp_path.rglob("*")] == ["file"]


def test_a_failed_write_leaves_the_old_file_and_nothing_else(
    tmp_path: Path, thrown_beam: bs.Response, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise RuntimeError("midway")

    (tmp_path / "response.nc").write_text("old")
    monkeypatch.setattr("bumpstop.io.netcdf_format._tie", fail)
    with pytest.raises(RuntimeError, match="midway"):
        thrown_beam.to_netcdf(tmp_path / "response.nc")
    assert [found.name for found in tmp_path.iterdir()] == ["response.nc"]
    assert (tmp_path / "response.nc").read_text() == "old"


def test_nodes_are_told_as_the_supports_carry_them(tmp_path: Path) -> None:
    case = bs.load_case(Path(__file__).parents[2] / "cases" / "sdnd102a-supports" / "case.toml")
    response = bs.simulate(case.problems["base"]).at(np.linspace(0.0, 0.3, 31))
    response.to_netcdf(tmp_path / "response.nc")
    with h5py.File(tmp_path / "response.nc") as file:
        nodes = [name.decode() for name in file["node"][:]]
        moved = file["displacement"][:, :, 0]
    for number, node in enumerate(nodes):
        expected = response.sample("displacement", node, "dx")
        np.testing.assert_allclose(moved[:, number], expected, atol=1e-18)
    assert np.abs(moved[:, nodes.index("SQ")]).max() > 2e-4
