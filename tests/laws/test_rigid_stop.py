"""Rigid stops as a user meets them; the core's tests hold their motion against references."""

import math
from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop import _core

GRAVITY = 9.81


def ball(restitution: float, duration: float = 3.0) -> bs.Problem:
    basis = bs.ModalBasis.from_modes(frequency=[0], damping=[0], shapes={("P", "dz"): [1]})
    floor = bs.RigidStop("floor", node="P", normal=(0, 0, 2), gap=1.0, restitution=restitution)
    weight = bs.NodalForce("weight", node="P", force=(0, 0, -GRAVITY))
    return bs.Problem(basis, laws=[floor], loads=[weight], duration=duration)


def test_a_bouncing_ball_has_the_impacts_of_the_closed_form_and_comes_to_rest() -> None:
    fall, restitution = math.sqrt(2.0 / GRAVITY), 0.5
    response = bs.simulate(ball(restitution))
    table = response.impact_table()
    rest = len(table["start"]) - 1
    flights = 2.0 * fall * restitution ** np.arange(1, rest)
    starts = fall + np.concatenate([[0.0], np.cumsum(flights)])
    assert np.abs(np.array(table["start"][:rest]) - starts).max() < 1e-9
    assert np.array_equal(table["end"][:rest], table["start"][:rest])
    assert np.isinf(np.array(table["peak_force"][:rest])).all()
    assert table["peak_force"][rest] == pytest.approx(GRAVITY, rel=1e-12)
    assert np.isnan(table["end"][rest])
    end = fall * (1 + restitution) / (1 - restitution)
    assert table["start"][rest] == pytest.approx(end, abs=1e-5)
    force = response.sample("stop_force", "floor", times=np.array([2.5]))
    assert force[0] == pytest.approx(GRAVITY, rel=1e-12)
    assert response.energy_residual < 1e-11


def test_tables_and_files_take_impacts_without_duration(tmp_path: Path) -> None:
    response = bs.simulate(ball(0.5))
    assert np.isinf(response.impacts["peak_force"]).any()
    assert (response.impacts["duration"].iloc[:-1] == 0.0).all()
    path = tmp_path / "ball.nc"
    response.to_netcdf(path)
    assert path.stat().st_size > 0


@pytest.mark.parametrize("restitution", [-0.1, 1.01, math.nan])
def test_a_restitution_out_of_its_range_is_refused(restitution: float) -> None:
    with pytest.raises(bs.InputError, match="restitution"):
        bs.RigidStop("floor", node="P", normal=(0, 0, 1), restitution=restitution)
    with pytest.raises(_core.CoreError, match="restitution"):
        _core.RigidStop(np.ones(1), 0.0, restitution)


def test_a_start_inside_is_refused() -> None:
    basis = bs.ModalBasis.from_modes(frequency=[1], damping=[0], shapes={("P", "dz"): [1]})
    floor = bs.RigidStop("floor", node="P", normal=(0, 0, 1), gap=-1e-3, restitution=1.0)
    with pytest.raises(bs.InputError, match=r"stops\.floor\.gap: .*0\.001 m inside"):
        bs.simulate(bs.Problem(basis, laws=[floor], duration=1.0))


@pytest.mark.parametrize("method", ["symplectic_euler", "central_difference"])
def test_methods_of_fixed_steps_refuse_it(method: str) -> None:
    with pytest.raises(bs.InputError, match="does not take rigid stops such as 'floor'"):
        bs.simulate(ball(0.5), method, dt=1e-3)


CASE = """
[nodes]
P = [0.0, 0.0, 0.0]
[masses.ball]
node = "P"
mass = 2.0
[[supports]]
nodes = ["P"]
fixed = ["dx", "dy", "drx", "dry", "drz"]
[basis]
modes = 1
damping = 0.0
[loads.weight]
type = "force"
node = "P"
force = [0.0, 0.0, -19.62]
[stops.floor]
node = "P"
normal = [0, 0, 1]
gap = "1 m"
{stop}
[run]
duration = 1.0
"""


def case(tmp_path: Path, stop: str) -> Path:
    path = tmp_path / "case.toml"
    path.write_text(CASE.format(stop=stop))
    return path


def test_a_case_file_says_its_restitution(tmp_path: Path) -> None:
    (problem,) = bs.load_case(case(tmp_path, "restitution = 0.7")).problems.values()
    table = bs.simulate(problem).impact_table()
    assert table["opening_speed"][0] == pytest.approx(0.7 * math.sqrt(2 * GRAVITY), rel=1e-12)


@pytest.mark.parametrize(
    ("stop", "message"),
    [
        ("restitution = 0.7\nstiffness = 1e4", "floor.stiffness: is of no use to a rigid stop"),
        ("restitution = 0.7\ndamping = 1.0", "floor.damping: is of no use to a rigid stop"),
        ("restitution = 1.7", "floor.restitution: must be from 0 to 1"),
        ("damping = 1.0", "stiffness"),
    ],
)
def test_a_case_file_that_contradicts_itself_is_refused(
    tmp_path: Path, stop: str, message: str
) -> None:
    with pytest.raises(bs.InputError, match=message):
        _ = bs.load_case(case(tmp_path, stop)).problems
