"""Files for other programs, each read by a program that is not ours."""

from __future__ import annotations

import sys
import tracemalloc
import wave
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import pyuff
from scipy.io import loadmat
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOHDF import vtkHDFReader

import bumpstop as bs
from bumpstop.io.wav import write_wav

from ..hinged_beam import SWING, end_stop, hinged_modes


@pytest.fixture(scope="module")
def thrown() -> bs.Response:
    """The beam of SDNL32 with 4 elements, thrown against its stop."""
    problem = bs.Problem(
        hinged_modes(elements=4, modes=3),
        laws=[end_stop(18e3)],
        initial=SWING,
        duration=0.02,
        sample=1e-4,
        gauges=[bs.Gauge("strain", beam="AB", at=0.462, fibre=(0.007, 0.0))],
        outputs=[("AB@0.462 m", "drz")],
    )
    return bs.simulate(problem)


COLUMNS = {
    "displacement_AB_0_462_m_drz": ("rad", ("displacement", "AB@0.462 m", "drz")),
    "acceleration_B_dy": ("m/s^2", ("acceleration", "B", "dy")),
    "stop_force_spring": ("N", ("stop_force", "spring")),
    "gap_spring": ("m", ("gap", "spring")),
    "gauge_strain": ("1", ("gauge", "strain")),
}


def test_pandas_reads_csv_to_the_bit(thrown: bs.Response, tmp_path: Path) -> None:
    thrown.export(tmp_path / "run.csv")
    table = pd.read_csv(tmp_path / "run.csv")
    np.testing.assert_array_equal(table["time [s]"], thrown.times)
    for name, (unit, target) in COLUMNS.items():
        np.testing.assert_array_equal(table[f"{name} [{unit}]"], thrown.sample(*target))
    assert len(table.columns) == 1 + 3 * 2 + 2 + 1


def test_pandas_reads_parquet(thrown: bs.Response, tmp_path: Path) -> None:
    thrown.export(tmp_path / "run.parquet")
    table = pd.read_parquet(tmp_path / "run.parquet")
    np.testing.assert_array_equal(table["time"], thrown.times)
    for name, (_, target) in COLUMNS.items():
        np.testing.assert_array_equal(table[name], thrown.sample(*target))


def test_pyarrow_finds_units(thrown: bs.Response, tmp_path: Path) -> None:
    from pyarrow import parquet

    thrown.export(tmp_path / "run.parquet")
    schema = parquet.read_schema(tmp_path / "run.parquet")
    for name, (unit, _) in COLUMNS.items():
        assert schema.field(name).metadata[b"units"] == unit.encode()


def test_pyuff_reads_universal_files(thrown: bs.Response, tmp_path: Path) -> None:
    thrown.export(tmp_path / "run.uff")
    found = pyuff.UFF(str(tmp_path / "run.uff")).read_sets()
    assert [each["type"] for each in found] == [164] + [58] * 9
    units, *functions = found
    assert (units["length"], units["force"]) == (1.0, 1.0)
    by_name = {each["id2"].strip(): each for each in functions}
    for name, (unit, target) in COLUMNS.items():
        values = thrown.sample(*target)
        read = by_name[name]
        np.testing.assert_allclose(read["data"], values, rtol=1e-11, atol=1e-300)
        np.testing.assert_allclose(read["x"], thrown.times, rtol=1e-9, atol=1e-12)
        assert read["ordinate_axis_units_lab"].strip() == unit
        assert read["func_type"] == 1
    tip = by_name["acceleration_B_dy"]
    assert (tip["rsp_node"], tip["rsp_dir"], tip["ordinate_spec_data_type"]) == (2, 2, 12)


def test_universal_files_tell_uneven_instants(thrown: bs.Response, tmp_path: Path) -> None:
    times = np.array([0.0, 1e-3, 1.5e-3, 7e-3, 7.25e-3])
    thrown.at(times).export(tmp_path / "run.uff")
    read = pyuff.UFF(str(tmp_path / "run.uff")).read_sets(1)
    np.testing.assert_allclose(read["x"], times, rtol=1e-5)
    values = thrown.sample("displacement", "AB@0.462 m", "drz", times=times)
    np.testing.assert_allclose(read["data"], values, rtol=1e-11)


def test_vtk_plays_the_motion(thrown: bs.Response, tmp_path: Path) -> None:
    thrown.export(tmp_path / "run.vtkhdf")
    reader = vtkHDFReader()
    reader.SetFileName(str(tmp_path / "run.vtkhdf"))
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == len(thrown.times)
    structure = thrown.problem.basis.structure
    assert structure is not None
    names = list(structure.mesh.names)
    for step in (0, 17, len(thrown.times) - 1):
        reader.SetStep(step)
        reader.Update()
        data = reader.GetOutput()
        at = [thrown.times[step]]
        points = vtk_to_numpy(data.GetPoints().GetData())
        np.testing.assert_allclose(points, structure.mesh.positions)
        moved = vtk_to_numpy(data.GetPointData().GetArray("displacement"))
        speed = vtk_to_numpy(data.GetPointData().GetArray("velocity"))
        force = vtk_to_numpy(data.GetPointData().GetArray("contact_force"))
        for row, node in enumerate(names):
            expected = thrown.sample("displacement", node, "dy", times=at)[0]
            # At the start it is rounding alone, of sums in another order.
            np.testing.assert_allclose(moved[row], [0.0, expected, 0.0], rtol=1e-12, atol=1e-18)
            expected = thrown.sample("velocity", node, "dy", times=at)[0]
            np.testing.assert_allclose(speed[row], [0.0, expected, 0.0], rtol=1e-12)
        pushed = np.zeros((len(names), 3))
        pushed[names.index("B"), 1] = thrown.sample("stop_force", "spring", times=at)[0]
        np.testing.assert_allclose(force, pushed, rtol=1e-12)
        assert data.GetNumberOfLines() == 1
        assert data.GetCell(0).GetNumberOfPoints() == 5


def test_scipy_loads_matlab_files(thrown: bs.Response, tmp_path: Path) -> None:
    thrown.export(tmp_path / "run.mat")
    found = loadmat(tmp_path / "run.mat", simplify_cells=True)
    np.testing.assert_array_equal(found["time"], thrown.times)
    for name, (unit, target) in COLUMNS.items():
        np.testing.assert_array_equal(found[name], thrown.sample(*target))
        assert found["units"][name] == unit
    impacts, table = found["impacts"], thrown.impact_table()
    assert impacts["stop"] == "spring"
    assert impacts["peak_force"] == table["peak_force"][0]
    assert found["events"]["time"] == thrown.event_table()["time"][0]
    assert found["method"] == "exact"


def test_python_plays_waves(thrown: bs.Response, tmp_path: Path) -> None:
    write_wav(thrown, tmp_path / "run.wav", "stop_force", "spring", rate=8000, slowed=100.0)
    with wave.open(str(tmp_path / "run.wav")) as file:
        assert (file.getframerate(), file.getnchannels(), file.getsampwidth()) == (8000, 1, 2)
        sound = np.frombuffer(file.readframes(file.getnframes()), dtype="<i2")
    assert len(sound) == 16001  # 0.02 s, a hundred times slower
    force = thrown.sample("stop_force", "spring", times=np.arange(16001) / 800_000)
    force = force - force.mean()
    np.testing.assert_allclose(sound, 0.99 * 32767 * force / np.abs(force).max(), atol=1.0)


def test_a_wave_without_the_blows_of_a_rigid_stop_is_refused(tmp_path: Path) -> None:
    basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    wall = bs.RigidStop("wall", node="P", normal=(1, 0, 0), gap=0.01, restitution=0.8)
    thrown = bs.ModalState(velocity=[-1.0])
    run = bs.simulate(bs.Problem(basis, laws=[wall], initial=thrown, duration=2.0))
    with pytest.raises(bs.InputError, match=r"stop: is rigid.*blows"):
        write_wav(run, tmp_path / "run.wav", "stop_force", "wall")
    assert not (tmp_path / "run.wav").exists()


def test_a_wave_is_the_first_velocity_where_nothing_is_said(
    thrown: bs.Response, tmp_path: Path
) -> None:
    thrown.export(tmp_path / "run.wav")
    with wave.open(str(tmp_path / "run.wav")) as file:
        sound = np.frombuffer(file.readframes(file.getnframes()), dtype="<i2").astype(float)
    speed = thrown.sample("velocity", "AB@0.462 m", "drz", times=np.arange(len(sound)) / 44_100)
    assert np.corrcoef(sound, speed)[0, 1] > 1.0 - 1e-8


def test_netcdf_is_among_the_formats(thrown: bs.Response, tmp_path: Path) -> None:
    thrown.export(tmp_path / "run.data", form="netcdf")
    assert (tmp_path / "run.data").read_bytes()[:4] == b"\x89HDF"


def test_many_samples_take_the_memory_of_few(thrown: bs.Response, tmp_path: Path) -> None:
    def most(samples: int) -> int:
        many = thrown.at(np.linspace(0.0, 0.02, samples))
        tracemalloc.start()
        many.export(tmp_path / "run.parquet")
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return peak

    most(1000)  # imports
    assert most(800_000) < 1.3 * most(200_000)


def test_what_cannot_be_exported(
    thrown: bs.Response, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(bs.InputError, match=r"run\.xls: does not tell a format by its ending.*csv"):
        thrown.export(tmp_path / "run.xls")
    with pytest.raises(bs.InputError, match=r"^format: "):
        thrown.export(tmp_path / "run.csv", form="exel")
    with pytest.raises(bs.InputError, match="cannot be written"):
        thrown.export(tmp_path / "nowhere" / "run.csv")
    with pytest.raises(bs.InputError, match=r"^slowed: "):
        write_wav(thrown, tmp_path / "run.wav", slowed=0.0)
    with pytest.raises(bs.InputError, match="more than a WAV file holds"):
        write_wav(thrown, tmp_path / "run.wav", slowed=1e7)
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(
        bs.InputError, match=r"pyarrow is needed.*pip install 'bumpstop\[parquet\]'"
    ):
        thrown.export(tmp_path / "run.parquet")
    assert list(tmp_path.iterdir()) == []


def test_a_basis_without_places_cannot_be_drawn(tmp_path: Path) -> None:
    basis = bs.ModalBasis.from_modes(frequency=[3.0], shapes={("P", "dx"): [1.0]})
    start = bs.ModalState(velocity=[1.0])
    response = bs.simulate(bs.Problem(basis, initial=start, duration=1.0))
    with pytest.raises(bs.InputError, match="has no places that could be drawn"):
        response.export(tmp_path / "run.vtkhdf")
    response.export(tmp_path / "run.csv")
    table = pd.read_csv(tmp_path / "run.csv")
    np.testing.assert_allclose(
        table["displacement_P_dx [m]"],
        np.sin(6 * np.pi * table["time [s]"]) / (6 * np.pi),
        atol=1e-12,
    )


def test_moving_supports_carry_what_is_exported(tmp_path: Path) -> None:
    wave_of_base = bs.BaseMotion(
        displacement=(0, 1e-3, 0), time=bs.Harmonic(40.0, sine=1.0), frame="absolute"
    )
    problem = bs.Problem(
        hinged_modes(elements=4, modes=3), loads=[wave_of_base], duration=0.02, sample=1e-3
    )
    response = bs.simulate(problem)
    response.export(tmp_path / "run.csv")
    response.export(tmp_path / "run.vtkhdf")
    table = pd.read_csv(tmp_path / "run.csv")
    node, dof = problem.basis.dofs[0]
    np.testing.assert_array_equal(
        table[f"displacement_{node}_{dof} [m]"], response.sample("displacement", node, dof)
    )
    reader = vtkHDFReader()
    reader.SetFileName(str(tmp_path / "run.vtkhdf"))
    reader.SetStep(7)
    reader.Update()
    moved = vtk_to_numpy(reader.GetOutput().GetPointData().GetArray("displacement"))
    assert problem.basis.structure is not None
    for row, name in enumerate(problem.basis.structure.mesh.names):
        expected = response.sample("displacement", name, "dy", times=[7e-3])[0]
        assert moved[row, 1] == pytest.approx(expected, rel=1e-12)
        assert abs(expected) > 1e-6


@pytest.fixture(scope="module")
def twins() -> bs.Response:
    """Nodes and stops whose names differ in punctuation alone, or behind a long beginning."""
    long = "support_of_the_third_tube_of_the_second_row_behind_the_inlet_at_level"
    nodes = ["P-1", "P_1", f"{long}_1", f"{long}_2"]
    shapes = {(node, "dx"): row for node, row in zip(nodes, np.eye(4).tolist(), strict=True)}
    basis = bs.ModalBasis.from_modes(frequency=[1.0, 2.0, 3.0, 4.0], shapes=shapes)
    stops = [
        bs.Stop(name, node=node, normal=(-1, 0, 0), gap=1e-2, stiffness=1e3 * (number + 1))
        for number, (name, node) in enumerate(zip(["s-1", "s_1"], nodes[:2], strict=True))
    ]
    start = bs.ModalState(velocity=[1.0, 2.0, 3.0, 4.0])
    outputs = [(node, "dx") for node in nodes]
    return bs.simulate(
        bs.Problem(basis, laws=stops, initial=start, duration=1.0, sample=1e-2, outputs=outputs)
    )


def told_apart(twins: bs.Response) -> list[np.ndarray]:
    """Return what must be somewhere in a file, whatever its name is."""
    displacements = [twins.sample("displacement", node, dof) for node, dof in twins.problem.outputs]
    return [*displacements, *(twins.sample("stop_force", stop) for stop in ("s-1", "s_1"))]


def test_names_that_differ_in_punctuation_stay_apart(twins: bs.Response, tmp_path: Path) -> None:
    for form in ("csv", "parquet", "mat"):
        twins.export(tmp_path / f"run.{form}")
    csv = pd.read_csv(tmp_path / "run.csv")
    heading = (tmp_path / "run.csv").read_text().splitlines()[0].split(",")
    assert len(set(heading)) == len(heading)
    parquet = pd.read_parquet(tmp_path / "run.parquet")
    mat = loadmat(tmp_path / "run.mat")
    tables = [
        [csv[name].to_numpy() for name in csv],
        [parquet[name].to_numpy() for name in parquet],
        [values[:, 0] for name, values in mat.items() if name[0] != "_" and values.size == 101],
    ]
    for columns in tables:
        for values in told_apart(twins):
            assert any(np.array_equal(values, column) for column in columns)
    assert max(len(name) for name in mat) <= 63
    assert parquet["stop_force_s_1"].tolist() == twins.sample("stop_force", "s-1").tolist()
    assert parquet["stop_force_s_1_2"].tolist() == twins.sample("stop_force", "s_1").tolist()


def test_netcdf_tells_such_nodes_apart(twins: bs.Response, tmp_path: Path) -> None:
    import xarray as xr

    twins.to_netcdf(tmp_path / "run.nc")
    assert bs.read_netcdf(tmp_path / "run.nc").equals(twins)
    with xr.open_dataset(tmp_path / "run.nc") as file:
        for node in ("P-1", "P_1"):
            (own,) = (
                each
                for each in file.data_vars.values()
                if each.attrs.get("node") == node and str(each.name).startswith("displacement")
            )
            np.testing.assert_array_equal(own, twins.sample("displacement", node, "dx"))


@pytest.mark.parametrize("number", [1, 2, 3, 4, 5])
def test_universal_files_of_few_instants(thrown: bs.Response, number: int, tmp_path: Path) -> None:
    few = thrown.at(thrown.times[:number])
    few.export(tmp_path / "run.uff")
    sets = pyuff.UFF(str(tmp_path / "run.uff")).read_sets()
    first = next(each for each in np.atleast_1d(sets) if each["type"] == 58)
    assert len(first["data"]) == number


def test_a_state_has_no_sound(thrown: bs.Response, tmp_path: Path) -> None:
    with pytest.raises(bs.InputError, match="unknown quantity"):
        write_wav(thrown, tmp_path / "run.wav", "state", "spring")
