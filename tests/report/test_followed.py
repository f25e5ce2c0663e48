"""What drawings follow of full models: all of their motion, or what a run has kept of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.report import write_report
from bumpstop.report.followed import followed_motion, unknown_places
from bumpstop.report.law_scene import law_nodes
from bumpstop.report.outline import outline

from .conftest import made_case

STEEL = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)


def thrown(elements: int) -> bs.Response:
    """A cantilever as a full model, shaken against a stop at its tip and one along it."""
    beam = bs.Beam(
        "AB", nodes=("A", "B"), elements=elements, material=STEEL,
        section=bs.Rectangle(height=0.02, width=0.01),
    )  # fmt: skip
    structure = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
        beams=[beam],
        supports=[bs.Support(nodes="A", fixed=("dx", "dy", "dz", "drx", "dry", "drz"))],
    )
    model = bs.FullModel.from_structure(structure)
    stops = [
        bs.Stop("tip", node="B", normal=(0, 0, 1), gap=1e-3, stiffness=1e5),
        bs.Stop("side", node="AB.2", normal=(0, 1, 0), gap=1e-4, stiffness=1e5),
    ]
    load = bs.NodalForce(
        "shaker", node="B", force=(0, 5.0, -20.0), time=bs.Harmonic(10.0, sine=1.0)
    )
    problem = bs.Problem(model, laws=stops, loads=[load], duration=0.1, sample=1e-3)
    return bs.simulate(problem, method="newmark", dt=1e-4)


@pytest.fixture
def partly(monkeypatch: pytest.MonkeyPatch) -> bs.Response:
    """The same, of which there was room for what the stops need alone."""
    monkeypatch.setattr("bumpstop.full.KEPT", 1)
    response = thrown(4)
    assert response.kept is not None
    assert len(response.kept) == 2
    return response


def travel(response: bs.Response, times: np.ndarray) -> tuple[dict[str, int], np.ndarray]:
    drawing = outline(response.problem.basis, law_nodes(response.problem))
    followed, amplitudes = followed_motion(response, drawing, times)
    return followed.nodes, np.einsum("pam,fm->fpa", followed.shapes, amplitudes)


def test_nodes_that_were_kept_move_and_beams_rest(partly: bs.Response) -> None:
    times = np.linspace(0.0, 0.1, 41)
    nodes, moved = travel(partly, times)
    np.testing.assert_array_equal(
        moved[:, nodes["B"], 2], partly.sample("displacement", "B", "dz", times=times)
    )
    np.testing.assert_array_equal(
        moved[:, nodes["AB.2"], 1], partly.sample("displacement", "AB.2", "dy", times=times)
    )
    moved[:, nodes["B"], 2] = moved[:, nodes["AB.2"], 1] = 0.0
    assert not moved.any()
    drawing = outline(partly.problem.basis, law_nodes(partly.problem))
    unknown = unknown_places(partly, drawing)
    assert not unknown[nodes["B"], 2]
    assert unknown[nodes["B"], 1]
    assert not unknown[nodes["A"]].any()  # it is held


def test_the_scene_and_the_report_are_drawn_and_say_so(partly: bs.Response, tmp_path: Path) -> None:
    figure = bs.draw_scene(partly, 1)
    tips = [frame.data[1] for frame in figure.frames]
    heights = [points.z[list(points.text).index("B")] for points in tips]
    times = np.linspace(0.0, 0.1, len(heights))
    expected = partly.sample("displacement", "B", "dz", times=times)
    np.testing.assert_allclose(heights, expected, rtol=1e-6, atol=1e-12)
    page = tmp_path / "report.html"
    write_report(made_case({"base": partly.problem}), {"base": partly}, {}, page)
    assert "beams that need others are drawn as they are at rest" in page.read_text()


def test_files_for_pictures_need_all_nodes(partly: bs.Response, tmp_path: Path) -> None:
    with pytest.raises(bs.InputError, match="kept that of a few dofs alone"):
        partly.export(tmp_path / "run.vtkhdf")
    assert not list(tmp_path.iterdir())


def test_many_dofs_are_drawn_by_few_shapes(tmp_path: Path) -> None:
    response = thrown(40)
    times = np.linspace(0.0, 0.1, 301)
    assert response.motion(0, times).shape[1] == 240
    drawing = outline(response.problem.basis, law_nodes(response.problem))
    followed, amplitudes = followed_motion(response, drawing, times)
    assert amplitudes.shape[1] < 40
    found = np.einsum("pam,fm->fpa", followed.shapes, amplitudes)
    exact = np.einsum("pam,fm->fpa", drawing.shapes, response.motion(0, times))
    np.testing.assert_allclose(found, exact, atol=1e-4 * np.abs(exact).max())
    page = tmp_path / "report.html"
    write_report(made_case({"base": response.problem}), {"base": response}, {}, page)
    assert page.stat().st_size < 8e6


def test_sliding_needs_the_directions_along_the_obstacle(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("bumpstop.full.KEPT", 1)
    with pytest.raises(bs.InputError, match="was not kept"):
        bs.wear_work(thrown(4), "tip")
