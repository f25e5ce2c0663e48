"""Basins of attraction: an oscillator that swings freely or hits its stop, as it starts."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, mpf
from scipy.integrate import solve_ivp

import bumpstop as bs
from bumpstop.cli import main
from bumpstop.study.basins import classified
from tests.reference.impact_oscillator import Oscillator, elastic_orbit, flight

HARD = Oscillator(0.05, 1.0, 1.5, spring=30.0)
"""Without impacts it swings to 0.79 of the gap; it can hit the stop once a period, too."""
PERIOD = float(HARD.period)
PERIODS = 90
TURNS = 2.0 * np.pi

CASE = f"""
title = "An oscillator before a stop"
[nodes]
P = [0.0, 0.0, 0.0]
[masses.ball]
node = "P"
mass = 1.0
[springs.spring]
node = "P"
stiffness = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]
[[supports]]
nodes = ["P"]
fixed = ["dy", "dz", "drx", "dry", "drz"]
[basis]
modes = 1
damping = {HARD.damping}
[stops.wall]
node = "P"
normal = [-1, 0, 0]
gap = 1.0
stiffness = {HARD.spring}
[loads.shaker]
type = "force"
node = "P"
force = [{HARD.forcing}, 0.0, 0.0]
harmonics = [{{ frequency = {HARD.frequency / TURNS!r}, cosine = 1.0 }}]
[initial.nodal.displacement]
P = {{ dx = 0.0 }}
[initial.nodal.velocity]
P = {{ dx = 0.0 }}
[run]
duration = {PERIODS * PERIOD!r}
"""
X, V = "initial.nodal.displacement.P.dx", "initial.nodal.velocity.P.dx"
STUDY = f"""
case = "case.toml"
[parameters]
"{X}" = {{ from = -1.6, to = 0.2, count = 7 }}
"{V}" = {{ from = -2, to = 2, count = 7 }}
[basins]
node = "P"
dof = "dx"
period = {PERIOD!r}
"""


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("basins")
    (folder / "case.toml").write_text(CASE)
    (folder / "study.toml").write_text(STUDY)
    return folder / "study.toml"


@pytest.fixture(scope="module")
def found(study: Path) -> xr.Dataset:
    return bs.load_study(study).run(workers=1)


def impacting_section() -> tuple[float, float]:
    """Return position and velocity of the orbit with an impact when the load is largest."""
    orbit = elastic_orbit(HARD, (0.18, 5.97, 0.56, 5.97), periods=1)
    with mp.workdps(30):
        left = orbit.start + orbit.contact
        x, v = flight(HARD).after(left, mpf(1), -orbit.leaving, HARD.period - left)
    return float(x), float(v)


def test_the_attractors_are_the_two_orbits(found: xr.Dataset) -> None:
    assert found.attractor_periods.values.tolist() == [1, 1]
    sections = {
        (float(x[0]), float(v[0]))
        for x, v in zip(
            found.attractor_displacement.values, found.attractor_velocity.values, strict=True
        )
    }
    free = tuple(float(value) for value in flight(HARD).steady(mpf(0)))
    expected = sorted([free, impacting_section()])
    # What is left of the transient after 90 periods: exp(-0.05 * 90 * 2 pi / 1.5) = 7e-9.
    np.testing.assert_allclose(sorted(sections), expected, atol=1e-6)


def integrated(x: float, v: float) -> tuple[float, float]:
    """Return the state after all periods, by an integrator that knows nothing of contacts."""

    def rates(t: float, y: Any) -> list[float]:
        force = HARD.forcing * np.cos(HARD.frequency * t) - float(HARD.spring or 0) * max(
            0.0, y[0] - 1.0
        )
        return [y[1], force - 2 * HARD.damping * y[1] - y[0]]

    end = solve_ivp(rates, (0, PERIODS * PERIOD), [x, v], "DOP853", rtol=1e-8, max_step=0.1).y
    return float(end[0, -1]), float(end[1, -1])


@pytest.mark.parametrize(("i", "j"), [(0, 3), (2, 4), (3, 3), (5, 6), (4, 1)])
def test_runs_end_where_another_integrator_says(i: int, j: int, found: xr.Dataset) -> None:
    run = found.isel({X: i, V: j})
    number = int(run.attractor)
    where = [
        float(each.values[number - 1, 0])
        for each in (found.attractor_displacement, found.attractor_velocity)
    ]
    np.testing.assert_allclose(where, integrated(float(run[X]), float(run[V])), atol=1e-3)


def test_both_basins_are_seen_and_counted(found: xr.Dataset) -> None:
    numbers, counts = np.unique(found.attractor.values, return_counts=True)
    assert numbers.tolist() == [1, 2]
    assert counts.tolist() == found.attractor_runs.values.tolist()
    assert counts[0] >= counts[1] > 3


def test_a_store_knows_them(
    study: Path, found: xr.Dataset, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    store = tmp_path / "b.zarr"
    words = ["sweep", str(study), "--store", str(store), "--workers", "2", "--json"]
    assert main(words) == 0
    record = json.loads(capsys.readouterr().out)
    assert [each["runs"] for each in record["attractors"]] == found.attractor_runs.values.tolist()
    assert bs.open_study(store).identical(found)
    study.write_text(STUDY + "tolerance = 2e-3\n")
    assert main([*words, "--resume"]) == 2
    assert "basins.tolerance was 0.001, and is 0.002" in capsys.readouterr().err
    study.write_text(STUDY)


LOOK = bs.Basins(node="P", dof="dx", period=1.0, most=4)


@given(
    periods=st.integers(1, 4),
    shift=st.integers(0, 3),
    points=st.lists(st.floats(-1, 1), min_size=4, max_size=4, unique_by=lambda x: round(x, 2)),
)
@settings(max_examples=30, deadline=None)
def test_the_same_orbit_begun_later_is_the_same(
    periods: int, shift: int, points: list[float]
) -> None:
    orbit = np.resize(points[:periods], 9)
    later = np.resize(np.roll(points[:periods], shift), 9)
    none = np.linspace(-1, 1, 9)
    classes = classified(LOOK, np.array([orbit, later, none]), np.zeros((3, 9)))
    assert classes.numbers.tolist() == [1, 1, 0]
    (attractor,) = classes.attractors
    assert (attractor.periods, attractor.runs) == (periods, 2)


def test_failed_runs_are_on_no_attractor() -> None:
    displacement = np.array([[np.nan] * 9, [0.5] * 9])
    assert classified(LOOK, displacement, np.zeros((2, 9))).numbers.tolist() == [0, 1]


def test_basins_that_cannot_be(study: Path) -> None:
    case = bs.load_case(study.parent / "case.toml")
    with pytest.raises(
        bs.InputError, match=r"basins.most: needs twice as many periods, and the run has 90"
    ):
        bs.study(case, {X: [0.0]}, {}, basins=bs.Basins(node="P", dof="dx", period=PERIOD, most=50))
    with pytest.raises(bs.InputError, match="unknown node"):
        bs.study(case, {X: [0.0]}, {}, basins=bs.Basins(node="Q", dof="dx", period=PERIOD))
    rows = np.random.default_rng(1).random((1100, 1)) * np.ones(9)
    with pytest.raises(bs.InputError, match="more than 1000 attractors"):
        classified(bs.Basins(node="P", dof="dx", period=1.0, most=4, tolerance=1e-9), rows, rows)
