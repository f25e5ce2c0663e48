"""How laws and springs are drawn."""

from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.report.law_scene import drawn_springs, law_nodes, undrawn_laws
from bumpstop.report.outline import outline
from bumpstop.report.scene import motion_scene

from .conftest import CASES

Scene = dict[str, Any]


def scene_of(response: bs.Response) -> Scene:
    problem = response.problem
    drawing = outline(problem.basis, law_nodes(problem))
    watched = problem.laws[0].coordinate.main_dof
    return motion_scene(response, watched, drawing)


def variant(name: str, which: str, **options: Any) -> bs.Response:
    return bs.simulate(bs.load_case(CASES / name / "case.toml").problems[which], **options)


@pytest.fixture(scope="module")
def whirling() -> bs.Response:
    return variant("tube-in-hole", "whirling", method="dop853", rtol=1e-9)


@pytest.fixture(scope="module")
def beside() -> bs.Response:
    """A tube that is thrown against the one beside it, 20 mm away."""
    shapes = {("P", "dy"): [1.0, 0.0], ("P", "dz"): [0.0, 1.0]}
    basis = bs.ModalBasis.from_modes(frequency=[0.0, 0.0], shapes=shapes)
    neighbour = bs.CircleStop(
        "neighbour", node="P", axis=(1, 0, 0), centre=(0, 20e-3, 0), radius=9.5e-3,
        body_radius=9.5e-3, side="outside", stiffness=1e6,
    )  # fmt: skip
    thrown = bs.ModalState(velocity=[1.0, 0.0])
    return bs.simulate(bs.Problem(basis, laws=[neighbour], initial=thrown, duration=2e-3))


def test_a_hole_is_drawn_about_its_node(whirling: bs.Response) -> None:
    (hole,) = scene_of(whirling)["laws"]
    assert hole["kind"] == "round"
    np.testing.assert_allclose(np.linalg.norm(hole["outline"], axis=1), 0.6e-3)
    # It lies across its axis.
    np.testing.assert_allclose(hole["outline"] @ hole["axis"], 0.0, atol=1e-18)


def test_the_force_in_space_points_at_the_centre(whirling: bs.Response) -> None:
    scene = scene_of(whirling)
    (hole,) = scene["laws"]
    places = scene["modal"] @ scene["shapes"][hole["point"]].T
    np.testing.assert_allclose(np.linalg.norm(hole["vectors"], axis=1), 40.0, rtol=1e-6)
    inwards = np.einsum("fa,fa->f", hole["vectors"], places)
    np.testing.assert_allclose(inwards, -40.0 * 0.8e-3, rtol=1e-6)
    np.testing.assert_allclose(hole["orbit"]["pushes"], -hole["orbit"]["places"] * 5e4, rtol=1e-6)


def test_of_a_tube_outside_the_near_side_is_drawn(beside: bs.Response) -> None:
    (tube,) = scene_of(beside)["laws"]
    outline_ = tube["orbit"]["outline"]
    np.testing.assert_allclose(np.linalg.norm(outline_, axis=1), 19e-3)
    near = np.linalg.norm(tube["outline"], axis=1)
    assert near.min() == pytest.approx(1e-3, rel=1e-3)  # the clearance
    assert near.max() < 8e-3
    # One arc: no jump from one end to the other.
    steps = np.linalg.norm(np.diff(outline_, axis=0), axis=1)
    assert steps.max() < 3.0 * np.median(steps)


def test_a_mover_between_moving_supports_is_drawn_where_it_is() -> None:
    response = variant("sdnd120a", "converged")
    drawing = outline(response.problem.basis, law_nodes(response.problem))
    scene = motion_scene(response, ("M2", "dx"), drawing)
    times = np.linspace(0.0, scene["duration"], scene["frames"] + 1)
    for node in ("M2", "S1"):
        drawn = scene["modal"] @ scene["shapes"][drawing.nodes[node], 0]
        np.testing.assert_allclose(
            drawn, response.sample("displacement", node, "dx", times=times), atol=1e-12
        )
    assert scene["magnifications"]["choices"][-1] <= 50  # 17 mm of 1 m
    (device,) = scene["laws"]
    assert (device["kind"], device["symbol"]) == ("link", "device")
    assert [each["name"] for each in scene["springs"]] == ["left", "right"]


def test_the_obstacle_between_two_nodes_goes_with_the_other_one() -> None:
    response = variant("sdnl111a", "base") if "base" in _variants("sdnl111a") else None
    response = response or variant("sdnl111a", _variants("sdnl111a")[0])
    (faces,) = scene_of(response)["laws"]
    other = response.problem.laws[0].coordinate.other
    assert other is not None
    times = np.linspace(0.0, response.problem.duration, len(faces["surfaces"]))
    moved = response.sample("displacement", other, "dx", times=times)
    along = response.problem.laws[0].coordinate.direction[0]
    gap = response.problem.laws[0].gap  # type: ignore[attr-defined]
    np.testing.assert_allclose(faces["surfaces"], along * moved - gap, atol=1e-12)


def _variants(name: str) -> list[str]:
    return list(bs.load_case(CASES / name / "case.toml").problems)


def test_a_sum_of_dofs_is_not_drawn_and_said() -> None:
    basis = bs.ModalBasis.from_modes(
        frequency=[1.0], shapes={("P", "dx"): [1.0], ("Q", "dx"): [0.5]}
    )
    stop = bs.Stop("sum", terms={("P", "dx"): 1.0, ("Q", "dx"): 2.0}, gap=1.0, stiffness=1.0)
    problem = bs.Problem(basis, laws=[stop], duration=1.0)
    assert undrawn_laws(problem) == ["sum"]
    assert scene_of(bs.simulate(problem))["laws"] == []


def test_springs_stand_on_the_ground_outside_the_structure() -> None:
    structure = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
        masses=[bs.PointMass("a", node="A", mass=1.0), bs.PointMass("b", node="B", mass=1.0)],
        springs=[
            bs.Spring("left", node="A", stiffness=(1e3, 0, 0, 0, 0, 0)),
            bs.Spring("right", node="B", stiffness=(1e3, 0, 0, 0, 0, 0)),
            bs.Spring("turning", node="B", stiffness=(0, 0, 0, 1.0, 0, 0)),
            bs.Spring("dashpot", node="A", other="B", damping=1.0),
        ],
        supports=[bs.Support(nodes="all", fixed=("dy", "dz", "drx", "dry", "drz"))],
    )
    basis = bs.ModalBasis.from_structure(structure, modes=2)
    left, right, dashpot = drawn_springs(basis, outline(basis), np.eye(3))
    assert (left["normal"][0], right["normal"][0]) == (1.0, -1.0)
    assert (dashpot["symbol"], dashpot["other"]) == ("damper", 1)


@pytest.fixture(scope="module")
def rubbing() -> bs.Response:
    """A block that is pressed onto a floor and pulled along it."""
    shapes = {("P", "dx"): [1.0, 0.0], ("P", "dy"): [0.0, 1.0]}
    basis = bs.ModalBasis.from_modes(frequency=[2.0, 3.0], damping=0.05, shapes=shapes)
    floor = bs.Stop(
        "floor", node="P", normal=(0, 1, 0), gap=-5e-3, stiffness=2e4, friction=0.3,
        sliding=(1, 0, 0), tangential_stiffness=5e3,
    )  # fmt: skip
    pull = bs.NodalForce("pull", node="P", force=(40, 0, 0), time=bs.Harmonic(0.7, sine=1.0))
    return bs.simulate(bs.Problem(basis, laws=[floor], loads=[pull], duration=2.0))


def test_the_slider_of_friction_is_drawn_where_it_stands(rubbing: bs.Response) -> None:
    scene = scene_of(rubbing)
    (floor,) = scene["laws"]
    times = np.linspace(0.0, 2.0, scene["frames"] + 1)
    anchor = rubbing.sample("internal_variable", "floor", "anchor", times=times)
    np.testing.assert_array_equal(floor["slider"]["places"], anchor)
    assert abs(floor["slider"]["direction"] @ floor["normal"]) < 1e-15
    assert np.linalg.norm(floor["slider"]["direction"]) == pytest.approx(1.0)


def test_the_slider_is_in_the_figure_in_space(rubbing: bs.Response) -> None:
    figure = bs.draw_scene(rubbing, 1)
    last = len(figure.frames) - 1
    times = np.linspace(0.0, 2.0, last + 1)
    anchors = rubbing.sample("internal_variable", "floor", "anchor", times=times)
    places = [
        0.5 * (np.min(frame.data[-1].x) + np.max(frame.data[-1].x)) for frame in figure.frames
    ]
    at_rest = figure.frames[0].data[1].x[0]
    np.testing.assert_allclose(places - at_rest, anchors, atol=1e-6)


def test_stops_without_friction_have_no_slider(soft: bs.Response) -> None:
    assert all("slider" not in law for law in scene_of(soft)["laws"])
