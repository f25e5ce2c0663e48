"""Responses read back from NetCDF files: equal, to the bit, to those that were written."""

from __future__ import annotations

import contextlib
import io
import tracemalloc
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pandas as pd
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

import bumpstop as bs
from bumpstop.io import netcdf, statement

from ..hinged_beam import SWING, end_stop, hinged_modes

CASES = Path(__file__).parents[2] / "cases"


def problems() -> Iterator[tuple[str, bs.Problem]]:
    for case in ("sdnl32", "sdnd100a", "ball-on-floor", "sdnl105b", "sdnl111a"):
        for name, problem in bs.load_case(CASES / case / "case.toml").problems.items():
            if name != "steps":  # takes its own scheme alone
                yield f"{case}-{name}", problem
    gauges = [bs.Gauge("strain", beam="AB", at=0.462, fibre=(0.007, 0.0))]
    outputs = [("AB@0.462 m", "drz")]
    yield (
        "free",
        bs.Problem(
            hinged_modes(elements=4, modes=3),
            initial=SWING,
            duration=0.02,
            gauges=gauges,
            outputs=outputs,
        ),
    )
    scaled = bs.ModalBasis.from_modes(
        frequency=[3.0, 7.5], modal_mass=[2.0, 0.3], damping=0.01, shapes={("P", "dx"): [1.0, 0.4]}
    )
    stop = bs.Stop("guide", node="P", normal=(-1, 0, 0), gap=1e-3, stiffness=1e6, damping=3.0)
    start = bs.ModalState(displacement=[0.0, 0.0], velocity=[0.2, 0.0])
    yield "scaled", bs.Problem(scaled, laws=[stop], initial=start, duration=1.0)


ALL = dict(problems())


def read_again(response: bs.Response, folder: Path) -> bs.Response:
    response.to_netcdf(folder / "response.nc")
    return bs.read_netcdf(folder / "response.nc")


@pytest.mark.parametrize("name", ALL)
def test_what_is_read_equals_what_was_written(name: str, tmp_path: Path) -> None:
    response = bs.simulate(ALL[name])
    again = read_again(response, tmp_path)
    assert again.equals(response)
    assert response.equals(again)
    assert bs.simulate(again.problem).equals(response)
    pd.testing.assert_frame_equal(again.impacts, response.impacts, check_exact=True)
    pd.testing.assert_frame_equal(again.events, response.events, check_exact=True)
    xr.testing.assert_identical(again.energy, response.energy)
    node, dof = response.problem.basis.dofs[-1]
    for quantity in ("displacement", "velocity", "acceleration"):
        # A file has the modes, whose sum is the node's: the core sums exponentials instead.
        expected = response.sample(quantity, node, dof)
        size = 1e-13 * np.abs(expected).max()
        np.testing.assert_allclose(again.sample(quantity, node, dof), expected, rtol=0, atol=size)
    assert again.solve_seconds > 0.0
    assert again.problem.remarks == response.problem.remarks


def test_gauges_and_fixed_steps_are_read(tmp_path: Path) -> None:
    problem = bs.Problem(
        hinged_modes(elements=4, modes=3),
        laws=[end_stop(18e3)],
        initial=SWING,
        duration=0.02,
        gauges=[bs.Gauge("strain", beam="AB", at=0.462, fibre=(0.007, 0.0))],
    )
    response = bs.simulate(problem, method="central_difference", dt=1e-5)
    again = read_again(response, tmp_path)
    assert again.equals(response)
    assert again.options == {"dt": 1e-5}
    expected = response.sample("gauge", "strain")
    np.testing.assert_allclose(
        again.sample("gauge", "strain"), expected, rtol=0, atol=1e-13 * np.abs(expected).max()
    )
    assert again.problem.basis.structure is not None
    assert not again.equals(bs.simulate(problem))


@given(
    frequencies=st.lists(st.floats(0.5, 50.0), min_size=1, max_size=4),
    gap=st.floats(0.0, 1e-2),
    stiffness=st.floats(1e2, 1e6),
    damping=st.floats(0.0, 10.0),
    speed=st.floats(-1.0, 1.0),
)
def test_any_response_comes_back(
    tmp_path_factory: pytest.TempPathFactory,
    frequencies: list[float],
    gap: float,
    stiffness: float,
    damping: float,
    speed: float,
) -> None:
    shape = [1.0] * len(frequencies)
    basis = bs.ModalBasis.from_modes(frequency=frequencies, shapes={("P", "dx"): shape})
    stop = bs.Stop(
        "guide", node="P", normal=(-1, 0, 0), gap=gap, stiffness=stiffness, damping=damping
    )
    start = bs.ModalState(velocity=[speed] * len(frequencies))
    problem = bs.Problem(basis, laws=[stop], initial=start, duration=0.3, sample=0.01)
    response = bs.simulate(problem)
    assert read_again(response, tmp_path_factory.mktemp("any")).equals(response)


def test_a_part_of_the_instants_can_be_read_alone(tmp_path: Path) -> None:
    response = bs.simulate(ALL["sdnl32-soft"])
    again = read_again(response, tmp_path)
    few = response.times[[0, 17, 2000]]
    assert again.at(few).equals(response.at(few))
    assert not again.at(few).equals(again)


@pytest.mark.parametrize("name", ALL)
def test_between_its_instants_a_file_repeats_the_run_to_the_bit(name: str, tmp_path: Path) -> None:
    response = bs.simulate(ALL[name]).at(np.linspace(0.0, ALL[name].duration, 7))
    again = read_again(response, tmp_path)
    assert not again.is_dense
    between = np.sort(np.random.default_rng(1).uniform(0.0, response.problem.duration, 500))
    assert again.at(between).equals(response.at(between))


def between(again: bs.Response, response: bs.Response) -> None:
    """Assert that both tell the same off the instants of the file."""
    times = np.random.default_rng(2).uniform(0.0, response.problem.duration, 100)
    for derivative in range(3):
        expected = response.motion(derivative, times)
        np.testing.assert_array_equal(again.motion(derivative, times), expected)


METHODS = {
    "central_difference": {"dt": 1e-5},
    "symplectic_euler": {"dt": 1e-5},
    "newmark": {"dt": 1e-5, "beta": 0.3, "gamma": 0.6},
    "trbdf2": {"dt": 1e-5},
    "rk54": {"rtol": 1e-6, "atol": 1e-9},
    "dop853": {"exact_flights": False},
    "adaptive_central_difference": {"points_per_period": 30.0},
}


@pytest.mark.parametrize("method", METHODS)
def test_methods_are_repeated_with_their_options(method: str, tmp_path: Path) -> None:
    response = bs.simulate(ALL["sdnl32-soft"], method, **METHODS[method])  # type: ignore[arg-type]
    between(read_again(response, tmp_path), response)


def test_a_run_that_is_not_that_of_the_file_is_refused(tmp_path: Path) -> None:
    """Motion that no run of the problem has: an instant of the file is read, another is not."""
    bs.simulate(ALL["scaled"]).to_netcdf(tmp_path / "run.nc")
    with h5py.File(tmp_path / "run.nc", "r+") as file:
        file["canonical_velocity"][-1] *= 1.0 + 1e-6
    again = bs.read_netcdf(tmp_path / "run.nc")
    assert len(again.sample("gap", "guide")) == len(again.times)
    with pytest.raises(bs.InputError, match="is not that of the file: the motion is") as caught:
        again.sample("gap", "guide", times=[0.123456])
    assert "\n" not in str(caught.value)
    with h5py.File(tmp_path / "run.nc", "r+") as file:
        file["event_time"][1] += 1e-6
    with pytest.raises(bs.InputError, match=r"is not that of the file: a law switches .* s apart"):
        bs.read_netcdf(tmp_path / "run.nc").sample("gap", "guide", times=[0.123456])


def test_contact_statistics_of_a_file_are_those_of_the_run(tmp_path: Path) -> None:
    basis = bs.ModalBasis.from_modes(
        frequency=[3.0, 7.5], damping=0.01, shapes={("P", "dx"): [1.0, 0.4]}
    )
    laws: list[Any] = [
        bs.Stop("soft", node="P", normal=(-1, 0, 0), gap=1e-3, stiffness=1e5, damping=30.0),
        bs.RigidStop("hard", node="P", normal=(1, 0, 0), gap=1e-3, restitution=0.7),
    ]
    push = bs.NodalForce("push", node="P", force=(5.0, 0, 0), time=bs.Harmonic(3.0, sine=1.0))
    response = bs.simulate(bs.Problem(basis, laws=laws, loads=[push], duration=3.0, sample=0.1))
    again = read_again(response, tmp_path)
    counting: list[dict[str, Any]]
    counting = [{}, {"threshold": 5.0, "rest": 1e-3}, {"start": 0.7, "end": 2.1, "blocks": 3}]
    for stop, options in [*(("soft", each) for each in counting), ("hard", {})]:
        live, stored = (bs.contact_statistics(run, stop, **options) for run in (response, again))
        assert live["impact_count"] > 3
        np.testing.assert_array_equal(list(stored.values.values()), list(live.values.values()))
        for name, values in live.blocks.items():
            np.testing.assert_array_equal(stored.blocks[name], values)


def test_sections_of_a_file_are_those_of_the_run(tmp_path: Path) -> None:
    """Periods that no instant of the file divides; without a stop the closed form tells them."""
    basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    start = bs.ModalState(velocity=[2.0 * np.pi])
    problem = bs.Problem(basis, initial=start, duration=20.0, sample=0.1)
    again = read_again(bs.simulate(problem), tmp_path)
    period = np.sqrt(2.0)
    section = bs.stroboscopic_section(again, "P", "dx", period, phase=0.3, start=2.0)
    expected = np.sin(2.0 * np.pi * section["time"])
    assert len(expected) == 12
    np.testing.assert_allclose(section["displacement"], expected, rtol=0, atol=1e-13)
    assert not bs.periodicity(again, period, tolerance=1e-9)
    assert bs.periodicity(again, 1.0, tolerance=1e-9).multiple == 1


def test_blocks_make_the_same_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    response = bs.simulate(ALL["sdnd100a-published"])
    response.to_netcdf(tmp_path / "whole.nc")
    monkeypatch.setattr(netcdf, "MOST_NUMBERS", 700)
    response.to_netcdf(tmp_path / "blocks.nc")
    assert bs.read_netcdf(tmp_path / "blocks.nc").equals(response)
    with (
        xr.open_dataset(tmp_path / "whole.nc", engine="h5netcdf") as whole,
        xr.open_dataset(tmp_path / "blocks.nc", engine="h5netcdf") as blocks,
    ):
        xr.testing.assert_allclose(blocks, whole, rtol=1e-12)
        assert list(blocks.variables) == list(whole.variables)


def test_many_samples_take_the_memory_of_few(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(netcdf, "MOST_NUMBERS", 200_000)
    response = bs.simulate(ALL["sdnl32-soft"])

    def most(samples: int) -> int:
        many = response.at(np.linspace(0.0, response.problem.duration, samples))
        tracemalloc.start()
        many.to_netcdf(tmp_path / "many.nc")
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return peak

    most(1000)  # imports
    assert most(80_000) < 1.3 * most(20_000)


def test_damaged_files(tmp_path: Path) -> None:
    bs.simulate(ALL["scaled"]).to_netcdf(tmp_path / "good.nc")
    content = (tmp_path / "good.nc").read_bytes()
    (tmp_path / "short.nc").write_bytes(content[: len(content) // 2])
    (tmp_path / "text.nc").write_text("time,displacement\n")
    for name in ("short.nc", "text.nc"):
        with pytest.raises(bs.InputError, match=f"{name}: is no response that bumpstop wrote"):
            bs.read_netcdf(tmp_path / name)
    with pytest.raises(bs.InputError, match=r"none\.nc: no such file"):
        bs.read_netcdf(tmp_path / "none.nc")


def test_files_without_a_problem(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(netcdf, "MOST_SHAPES", 1)
    bs.simulate(ALL["scaled"]).to_netcdf(tmp_path / "large.nc")
    with pytest.raises(bs.InputError, match=r"large\.nc: holds no problem \(written by 0"):
        bs.read_netcdf(tmp_path / "large.nc")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b"bumpstop.laws.stop:Stop", b"os:system"),
        (b"bumpstop.laws.stop:Stop", b"bumpstop.files:written_whole"),
        (b'"stiffness"', b'"stifness"'),
    ],
)
def test_nothing_but_data_is_made_of_a_file(tmp_path: Path, old: bytes, new: bytes) -> None:
    bs.simulate(ALL["scaled"]).to_netcdf(tmp_path / "response.nc")
    packed = statement.packed(ALL["scaled"])
    arrays = dict(np.load(io.BytesIO(packed)))
    tree = arrays["statement"].tobytes()
    assert old in tree
    arrays["statement"] = np.frombuffer(tree.replace(old, new), dtype=np.uint8)
    content = io.BytesIO()
    np.savez(content, allow_pickle=False, **arrays)
    with h5py.File(tmp_path / "response.nc", "r+") as file:
        del file["problem"]
        file["problem"] = np.frombuffer(content.getvalue(), dtype=np.uint8)
    with pytest.raises(bs.InputError, match="holds a problem that cannot be made here"):
        bs.read_netcdf(tmp_path / "response.nc")


def test_a_file_with_flipped_bytes_is_read_or_refused(tmp_path: Path) -> None:
    """No other error than that of a file that cannot be used."""
    basis = bs.ModalBasis.from_modes(frequency=[1.0], shapes={("P", "dx"): [1.0]})
    start = bs.ModalState(velocity=[1.0])
    run = bs.simulate(bs.Problem(basis, initial=start, duration=1.0, sample=0.1))
    run.to_netcdf(tmp_path / "run.nc")
    content = (tmp_path / "run.nc").read_bytes()
    chance = np.random.default_rng(0)
    for _ in range(60):
        damaged = bytearray(content)
        for place in chance.integers(0, len(content), 20):
            damaged[place] ^= int(chance.integers(1, 256))
        (tmp_path / "damaged.nc").write_bytes(damaged)
        with contextlib.suppress(bs.BumpstopError):
            bs.read_netcdf(tmp_path / "damaged.nc")
