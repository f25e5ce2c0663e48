"""Structures made of parts, in the report and in response files."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import bumpstop as bs
from bumpstop.report.outline import outline
from bumpstop.report.scene import mode_scene
from bumpstop.report.summary import model_rows
from bumpstop.structure.dofs import DOFS


@pytest.fixture(scope="module")
def problem() -> bs.Problem:
    steel = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
    bar = bs.Rectangle(height=0.06, width=0.025)
    beam = bs.Beam("AB", nodes=("A", "B"), elements=4, material=steel, section=bar)
    model = bs.Structure(nodes={"A": (0, 0, 0), "B": (2, 0, 0)}, beams=[beam])
    reduced = bs.craig_bampton(bs.Component(model, interface=["A", "B"]), modes=3)
    knee = bs.Assembly(
        parts={
            "post": bs.Placed(reduced, rotation=bs.Rotation((0, 1, 0), -math.pi / 2)),
            "arm": bs.Placed(reduced, at=(0, 0, 2)),
        },
        joints=[bs.Joint("post.B", "arm.A", dofs=("dx", "dy", "dz", "dry", "drz", "drx"))],
        supports=[bs.Support(nodes="post.A", fixed=DOFS)],
    )
    basis = bs.ModalBasis.from_structure(knee, modes=4)
    stop = bs.Stop("floor", node="arm.AB@1.5", normal=(0, 0, 1), gap=1e-3, stiffness=1e5)
    weight = bs.Gravity("weight", acceleration=(0, 0, -9.81))
    return bs.Problem(basis, laws=[stop], loads=[weight], duration=0.1, sample=0.01)


def test_the_beams_of_all_parts_are_drawn_in_their_places(problem: bs.Problem) -> None:
    drawing = outline(problem.basis, ["arm.AB@1.5"])
    assert not drawing.schematic
    assert len(drawing.lines) == 2
    assert list(drawing.nodes) == ["post.A", "post.B", "arm.A", "arm.B", "arm.AB@1.5"]
    places = drawing.positions[list(drawing.nodes.values())]
    expected = [(0, 0, 0), (0, 0, 2), (0, 0, 2), (2, 0, 2), (1.5, 0, 2)]
    np.testing.assert_allclose(places, expected, atol=1e-15)
    first, count = drawing.lines[0]
    heights = drawing.positions[first : first + count]
    np.testing.assert_allclose(heights[:, 2], np.linspace(0, 2, count), atol=1e-15)
    np.testing.assert_array_equal(
        drawing.shapes[drawing.nodes["arm.B"]][2], problem.basis.row("arm.B", "dz")
    )
    (support,) = mode_scene(problem.basis, drawing)["supports"]
    assert (support["point"], support["kind"]) == (drawing.nodes["post.A"], "clamp")


def test_parts_and_joints_are_told(problem: bs.Problem) -> None:
    rows = dict(model_rows(problem))
    assert rows["Parts"] == [
        "post: at (0, 0, 0) m, turned, interface A, B, 3 inner shapes",
        "arm: at (0, 0, 2) m, interface A, B, 3 inner shapes",
    ]
    assert rows["Joints"] == ["post.B and arm.A: dx, dy, dz, dry, drz, drx"]
    assert rows["Supports"] == ["post.A: dx, dy, dz, drx, dry, drz fixed"]


def test_all_nodes_of_parts_are_written_to_files(problem: bs.Problem, tmp_path: Path) -> None:
    response = bs.simulate(problem)
    response.to_netcdf(tmp_path / "response.nc")
    with xr.open_dataset(tmp_path / "response.nc") as file:
        assert file.node.values.tolist()[:3] == ["post.A", "post.B", "post.AB.1"]
        assert file.sizes["node"] == 10
        motion = file.displacement.sel(node=(file.node == "arm.AB.2"), dof=(file.dof == "dz"))
        np.testing.assert_allclose(
            motion.values.ravel(), response.sample("displacement", "arm.AB.2", "dz"), atol=1e-12
        )
        np.testing.assert_allclose(file.z.values[file.node.values == "arm.B"], 2.0)


def test_matrices_without_places_have_no_nodes_in_files(tmp_path: Path) -> None:
    matrices = bs.Matrices(stiffness=[[1e4]], mass=[[1.0]], dofs=[("P", "dx")])
    basis = bs.ModalBasis.from_structure(matrices, modes=1)
    problem = bs.Problem(basis, initial=bs.ModalState(velocity=[1.0]), duration=0.1)
    bs.simulate(problem).to_netcdf(tmp_path / "response.nc")
    with xr.open_dataset(tmp_path / "response.nc") as file:
        assert "node" not in file


def test_a_dof_that_a_node_does_not_have_stays_in_place(tmp_path: Path) -> None:
    matrices = bs.Matrices(
        stiffness=[[1e4, 0], [0, 2e4]],
        mass=[[1.0, 0], [0, 1.0]],
        dofs=[("P", "dx"), ("Q", "dy")],
        positions={"P": (0, 0, 0), "Q": (1, 0, 0)},
    )
    basis = bs.ModalBasis.from_structure(matrices, modes=2)
    problem = bs.Problem(basis, initial=bs.ModalState(velocity=[1.0, 1.0]), duration=0.1)
    bs.simulate(problem).to_netcdf(tmp_path / "response.nc")
    with xr.open_dataset(tmp_path / "response.nc") as file:
        moved = np.abs(file.displacement.values).max(axis=0) > 0.0
        np.testing.assert_array_equal(moved, [[True, False], [False, True]])
