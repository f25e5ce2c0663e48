"""What laws remember, against their forces, their energies and the motion itself."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from numpy.testing import assert_allclose
from scipy.io import loadmat

import bumpstop as bs
from bumpstop.problem import Law

PLANE = {("P", "dx"): [1.0, 0.0], ("P", "dy"): [0.0, 1.0]}


def driven(law: Law, method: str = "auto", dt: float | None = None) -> bs.Response:
    """A body on two springs, driven along both of them."""
    basis = bs.ModalBasis.from_modes(frequency=[3.0, 4.0], damping=0.02, shapes=PLANE)
    load = bs.NodalForce("f", node="P", force=(9.0, 6.0, 0), time=bs.Harmonic(2.3, sine=1.0))
    problem = bs.Problem(basis, laws=[law], loads=[load], duration=2.0, sample=1e-3)
    return bs.simulate(problem, method, dt=dt)


STICK, DAMPER = 2e3, 3.0
RUBBING = bs.Stop(
    "law",
    node="P",
    normal=(-1, 0, 0),
    gap=2e-3,
    stiffness=4e3,
    damping=5.0,
    friction={"static": 0.4, "dynamic": 0.3},
    sliding=(0, 1, 0),
    tangential_stiffness=STICK,
    tangential_damping=DAMPER,
)


@pytest.mark.parametrize("method", ["exact", "central_difference", "dop853"])
def test_the_anchor_of_friction_is_where_its_spring_ends(method: str) -> None:
    """In contact T = -kt (x - a), and while it sticks the damper's share beside it."""
    run = driven(RUBBING, method, 1e-4 if method == "central_difference" else None)
    anchor = run.sample("internal_variable", "law", "anchor")
    state = run.sample("state", "law")
    away = np.isin(state, ["open", "released"])
    assert np.isnan(anchor[away]).all()
    assert away.any()
    place, speed = (run.sample(q, "P", "dy") for q in ("displacement", "velocity"))
    sticks = state == "stick"
    assert sticks.sum() > 20
    assert (~sticks & ~away).sum() > 20
    force = -STICK * (place - anchor) - np.where(sticks, DAMPER * speed, 0.0)
    expected = run.sample("friction_force", "law")
    assert_allclose(force[~away], expected[~away], atol=1e-10 * np.abs(expected).max())
    # While it sticks the anchor stays.
    both = sticks[1:] & sticks[:-1]
    moved = np.abs(np.diff(anchor)[both])
    assert np.median(moved) == 0.0


def test_stretches_of_a_round_stop_store_what_the_ledger_says() -> None:
    law = bs.CircleStop(
        "law",
        node="P",
        axis=(0, 0, 1),
        radius=1.2e-2,
        body_radius=1e-2,
        stiffness=4e3,
        friction=0.3,
        tangential_stiffness=STICK,
    )
    run = driven(law)
    found = run.internal_variables("law")
    stretch2 = found["stretch_around"] ** 2 + found["stretch_axial"] ** 2
    depth = np.maximum(0.0, -run.sample("gap", "law"))
    stored = 0.5 * 4e3 * depth**2 + 0.5 * STICK * np.nan_to_num(stretch2.values)
    expected = run.energy["stored"].values
    assert_allclose(stored, expected, atol=1e-9 * expected.max())
    assert np.nanmax(np.abs(found["stretch_around"])) > 1e-5
    assert found["stretch_around"].attrs["units"] == "m"


def test_plastic_elongation_is_what_the_spring_does_not_give_back() -> None:
    """F = K (U - Up), and the path is how far Up has gone, back and forth."""
    law = bs.HardeningSpring(
        "law", node="P", direction=(1, 0, 0), curve=[(2e-3, 4.0), (8e-3, 6.0), (2e-2, 7.0)]
    )
    run = driven(law)
    found = run.internal_variables("law")
    elongation = run.sample("displacement", "P", "dx")
    part, path = found["plastic_elongation"].values, found["plastic_path"].values
    force = run.sample("stop_force", "law")
    assert_allclose(-2e3 * (elongation - part), force, atol=1e-9 * np.abs(force).max())
    assert np.ptp(part) > 1e-3
    assert_allclose(path, np.concatenate([[0.0], np.cumsum(np.abs(np.diff(part)))]), atol=2e-5)
    assert (np.diff(path) >= -1e-15).all()


def test_a_stop_that_buckles_remembers_its_largest_crushing() -> None:
    law = bs.BucklingStop(
        "law", node="P", normal=(-1, 0, 0), stiffness=3e3, critical_force=6.0, post_force=4.0
    )
    run = driven(law)
    found = run.internal_variables("law")
    largest = np.maximum.accumulate(np.maximum(0.0, -run.sample("gap", "law")))
    buckled = found["largest_crushing"].values > 0.0
    assert buckled.any()
    assert not buckled[0]
    # Between samples the crushing may have been a little larger.
    assert_allclose(found["largest_crushing"][buckled], largest[buckled], rtol=1e-3)
    left = found["residual_crushing"].values[buckled]
    assert (left <= found["largest_crushing"].values[buckled]).all()
    assert left[-1] > 0.0


def test_the_dashpot_of_a_zener_damper_closes_its_forces() -> None:
    k1, k2, k3 = 3e3, 500.0, 900.0
    law = bs.ZenerDamper(
        "law",
        node="P",
        direction=(1, 0, 0),
        series_stiffness=k1,
        parallel_stiffness=k2,
        branch_stiffness=k3,
        damping=20.0,
        exponent=0.7,
    )
    run = driven(law)
    dashpot = run.internal_variables("law")["dashpot_elongation"].values
    whole, force = run.sample("displacement", "P", "dx"), run.sample("stop_force", "law")
    pair = (k1 * whole + k3 * dashpot) / (k1 + k2 + k3)
    assert_allclose(-(k2 * pair + k3 * (pair - dashpot)), force, atol=1e-9 * np.abs(force).max())
    branch = k3 * (pair - dashpot)
    rate = np.sign(branch) * np.abs(branch / 20.0) ** (1.0 / 0.7)
    steps = 0.5e-3 * (rate[1:] + rate[:-1])
    assert_allclose(np.diff(dashpot), steps, atol=2e-3 * np.abs(steps).max())


def test_the_memory_of_a_law_of_ones_own() -> None:
    law = bs.UserLaw(
        "law",
        node="P",
        direction=(1, 0, 0),
        force=lambda q, _v, _t, z: -10.0 * q - z,
        memory_rate=lambda _q, _v, _t, _z: 0.5,
        memory=2.0,
    )
    run = driven(law)
    memory = run.internal_variables("law")["memory"]
    assert_allclose(memory, 2.0 + 0.5 * run.times, rtol=1e-9)


def test_laws_that_remember_nothing_say_so() -> None:
    stop = bs.Stop("law", node="P", normal=(-1, 0, 0), gap=2e-3, stiffness=4e3)
    with pytest.raises(bs.InputError, match=r"^law: remembers nothing"):
        driven(stop).internal_variables("law")
    with pytest.raises(bs.InputError, match=r"^variable: unknown variable"):
        driven(RUBBING).sample("internal_variable", "law", "ankor")
    with pytest.raises(bs.InputError, match="target: internal_variable is that of a law and a"):
        driven(RUBBING).sample("internal_variable", "law")


def test_files_have_them(tmp_path: Path) -> None:
    run = driven(RUBBING)
    anchor = run.sample("internal_variable", "law", "anchor")
    run.to_netcdf(tmp_path / "run.nc")
    again = bs.read_netcdf(tmp_path / "run.nc")
    assert again.equals(run)
    np.testing.assert_array_equal(again.sample("internal_variable", "law", "anchor"), anchor)
    with xr.open_dataset(tmp_path / "run.nc", engine="h5netcdf") as file:
        np.testing.assert_array_equal(file["internal_anchor_law"], anchor)
        assert file["internal_anchor_law"].attrs["units"] == "m"
    for form in ("csv", "parquet", "mat"):
        run.export(tmp_path / f"run.{form}")
    columns = [
        pd.read_csv(tmp_path / "run.csv")["anchor_law [m]"],
        pd.read_parquet(tmp_path / "run.parquet")["anchor_law"],
        loadmat(tmp_path / "run.mat", simplify_cells=True)["anchor_law"],
    ]
    for column in columns:
        np.testing.assert_array_equal(column, anchor)
    run.export(tmp_path / "run.uff")  # which has no place for it
