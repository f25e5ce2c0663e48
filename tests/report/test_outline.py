"""Outlines, views and frames: what is drawn is where it is."""

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.report import tables
from bumpstop.report.outline import outline, view_of
from bumpstop.report.scene import mode_scene, motion_scene

from .conftest import Run

STEEL = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
BAR = bs.Rectangle(height=0.02, width=0.01)
ALL = ("dx", "dy", "dz", "drx", "dry", "drz")


def portal() -> bs.Structure:
    """A frame in the y-z plane: two posts and a beam, one foot clamped, one on a roller."""
    beams = [("left", ("A", "B")), ("top", ("B", "C")), ("right", ("C", "D"))]
    return bs.Structure(
        nodes={"A": (0, 0, 0), "B": (0, 0, 1), "C": (0, 2, 1), "D": (0, 2, 0)},
        beams=[
            bs.Beam(name, nodes=ends, elements=2, material=STEEL, section=BAR)
            for name, ends in beams
        ],
        masses=[bs.PointMass("lump", node="C", mass=3.0)],
        supports=[
            bs.Support(nodes="all", fixed=("dx", "dry", "drz")),
            bs.Support(nodes="A", fixed=ALL),
            bs.Support(nodes="D", fixed=("dz",)),
        ],
    )


@pytest.fixture(scope="module")
def frame() -> bs.ModalBasis:
    return bs.ModalBasis.from_structure(portal(), modes=3)


def test_points_lie_on_the_beams_and_move_as_the_basis_says(frame: bs.ModalBasis) -> None:
    drawn = outline(frame, ["top@0.7"])
    (start, count) = drawn.lines[1]
    top = drawn.positions[start : start + count]
    np.testing.assert_allclose(top[:, 1], np.linspace(0.0, 2.0, count))
    np.testing.assert_allclose(top[:, [0, 2]], [[0.0, 1.0]] * count)
    place = drawn.nodes["top@0.7"]
    np.testing.assert_allclose(drawn.positions[place], [0.0, 0.7, 1.0])
    np.testing.assert_array_equal(drawn.shapes[place, 1], frame.row("top@0.7", "dy"))


def test_a_rigid_mode_is_drawn_straight(soft: bs.Response) -> None:
    drawn = outline(soft.problem.basis)
    (start, count) = drawn.lines[0]
    x = drawn.positions[start : start + count, 0]
    rigid = drawn.shapes[start : start + count, 1, 0]
    np.testing.assert_allclose(rigid, rigid[-1] * x / x[-1], atol=1e-10 * abs(rigid[-1]))


def test_a_basis_without_geometry_is_drawn_side_by_side(pendulum: bs.Problem) -> None:
    drawn = outline(pendulum.basis)
    assert drawn.schematic
    assert drawn.lines == []
    assert np.ptp(drawn.positions[:, 0]) == 0.0  # not along the motion
    assert len(np.unique(drawn.positions, axis=0)) == 2
    np.testing.assert_array_equal(drawn.shapes[0, 0], [1.0, 0.4])


@pytest.mark.parametrize(
    ("positions", "motion", "right", "up"),
    [
        ([[0, 0, 0], [1, 0, 0]], [0, 1, 0], [1, 0, 0], [0, 1, 0]),
        ([[0, 0, 0], [1, 0, 0]], [0, 0, 1], [1, 0, 0], [0, 0, 1]),
        ([[0, 0, 0], [0, 2, 0]], [0, 0, 1e-3], [0, 1, 0], [0, 0, 1]),
        ([[0, 0, 0]], [0, 0, 1], [1, 0, 0], [0, 0, 1]),
        ([[0, 0, 0]], [0, 1, 0], [1, 0, 0], [0, 1, 0]),
        ([[0, 0, 0]], [0, 0, 0], [1, 0, 0], [0, 1, 0]),
    ],
)
def test_plane_problems_are_seen_at_a_right_angle(
    positions: list[list[float]], motion: list[float], right: list[float], up: list[float]
) -> None:
    view = view_of(np.array(positions, dtype=float), np.array(motion, dtype=float))
    np.testing.assert_array_equal(view, [right, up])


def test_spatial_problems_are_seen_at_an_angle_without_distortion() -> None:
    view = view_of(np.array([[0.0, 0, 0], [1, 1, 0]]), np.array([0.0, 0.0, 1.0]))
    np.testing.assert_allclose(view @ view.T, np.eye(2), atol=1e-15)
    towards_the_eye = np.cross(view[0], view[1])
    assert towards_the_eye[2] > 0.0  # seen from above
    assert view[1, 2] > 0.9  # what rises is drawn rising


def test_supports_are_drawn_as_what_they_hold(frame: bs.ModalBasis) -> None:
    drawn = outline(frame)
    kinds = {each["point"]: each for each in mode_scene(frame, drawn)["supports"]}
    foot = kinds[drawn.nodes["A"]]
    assert foot["kind"] == "clamp"
    np.testing.assert_array_equal(foot["normal"], [0.0, 1.0])  # the post stands on it
    roller = kinds[drawn.nodes["D"]]
    assert roller["kind"] == "roller"
    np.testing.assert_array_equal(roller["normal"], [0.0, 1.0])
    assert set(kinds) == {drawn.nodes["A"], drawn.nodes["D"]}


def test_the_hinge_is_a_pin(soft: bs.Response) -> None:
    drawn = outline(soft.problem.basis)
    (pin,) = mode_scene(soft.problem.basis, drawn)["supports"]
    assert (pin["point"], pin["kind"]) == (drawn.nodes["A"], "pin")


def test_masses_are_bodies(frame: bs.ModalBasis) -> None:
    drawn = outline(frame)
    assert mode_scene(frame, drawn)["bodies"] == [drawn.nodes["C"]]


def test_modes_are_drawn_alike_in_size(frame: bs.ModalBasis) -> None:
    shapes = mode_scene(frame, outline(frame))["shapes"]
    np.testing.assert_allclose(np.linalg.norm(shapes, axis=1).max(axis=0), 1.0)


def test_frames_are_the_response(soft: bs.Response) -> None:
    drawn = outline(soft.problem.basis, ["B"])
    scene = motion_scene(soft, ("B", "dy"), drawn)
    tip = drawn.nodes["B"]
    np.testing.assert_allclose(
        scene["modal"] @ scene["shapes"][tip, 1],
        soft.sample(
            "displacement",
            "B",
            "dy",
            times=np.linspace(0.0, scene["duration"], scene["frames"] + 1),
        ),
        atol=1e-15,
    )
    assert scene["duration"] == 0.02
    (stop,) = scene["laws"]
    assert stop["contacts"] == [(0.0, soft.impact_table()["end"][0])]
    np.testing.assert_allclose(stop["normal"], [0.0, 1.0, 0.0])
    deepest = -float(soft.sample("displacement", "B", "dy").min())
    assert -stop["lowest"] == pytest.approx(deepest, rel=1e-6)


def test_the_magnified_motion_fits_and_can_be_read(soft: bs.Response) -> None:
    scene = motion_scene(soft, ("B", "dy"), outline(soft.problem.basis, ["B"]))
    choices, first = scene["magnifications"]["choices"], scene["magnifications"]["first"]
    largest = np.abs(soft.sample("displacement", "B", "dy")).max()
    assert 0.1 * 0.783 < choices[first] * largest <= 0.3 * 0.783
    assert choices[0] == 1


def test_bodies_alone_are_drawn_to_scale(ball: Run, pendulum: bs.Problem) -> None:
    for response in (ball.responses["base"], bs.simulate(pendulum, method="exact")):
        node = response.problem.laws[0].coordinate.node
        drawn = outline(response.problem.basis, [node])
        scene = motion_scene(response, (node, "dx"), drawn) if drawn.schematic else None
        scene = scene or motion_scene(response, (node, "dz"), drawn)
        assert scene["magnifications"] == {"choices": [1], "first": 0}
        assert scene["bodies"]


def test_busy_motions_get_more_frames_within_bounds(
    bouncing: bs.Response, soft: bs.Response
) -> None:
    def frames(response: bs.Response, node: str) -> int:
        drawn = outline(response.problem.basis, [node])
        return int(motion_scene(response, (node, "dy"), drawn)["frames"]) + 1

    impacts = len(bouncing.impact_table()["start"])
    assert frames(bouncing, "P") > 20 * impacts
    assert frames(soft, "B") == 1001


def test_a_structure_in_space_has_a_depth(portal: bs.ModalBasis) -> None:
    drawn = outline(portal)
    assert drawn.spatial
    scene = mode_scene(portal, drawn)
    assert scene["points"].shape == (len(drawn.positions), 3)
    # The axes of the paper are at right angles, so that distances stay.
    steps, true_steps = (np.diff(each, axis=0) for each in (scene["points"], drawn.positions))
    np.testing.assert_allclose(
        np.linalg.norm(steps, axis=1), np.linalg.norm(true_steps, axis=1), atol=1e-12
    )
    np.testing.assert_allclose(np.linalg.norm(scene["shapes"], axis=1).max(axis=0), 1.0)
    feet = scene["points"][[drawn.nodes["foot0"], drawn.nodes["top0"]]]
    np.testing.assert_allclose(feet[1] - feet[0], 3.0 * scene["vertical"], atol=1e-12)
    assert [support["kind"] for support in scene["supports"]] == ["clamp"] * 4
    for support in scene["supports"]:
        np.testing.assert_allclose(support["normal"], scene["vertical"], atol=1e-12)


def test_a_plane_frame_has_none(frame: bs.ModalBasis) -> None:
    drawn = outline(frame)
    assert not drawn.spatial
    scene = mode_scene(frame, drawn)
    assert scene["points"].shape[1] == 2
    assert "vertical" not in scene


def test_a_roller_in_space_stands_upright_and_torsion_is_not_seen() -> None:
    beam = bs.Beam("AB", nodes=("A", "B"), elements=4, material=STEEL, section=BAR)
    structure = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (0.1, 0, 0)},
        beams=[beam],
        supports=[
            bs.Support(nodes="A", fixed=("dx", "dy", "dz", "drx")),
            bs.Support(nodes="B", fixed=("dy", "dz")),
        ],
    )
    basis = bs.ModalBasis.from_structure(structure, modes=12)
    drawn = outline(basis)
    assert 0 < drawn.seen.count(False) < 12
    scene = mode_scene(basis, drawn)
    roller = next(each for each in scene["supports"] if each["kind"] == "roller")
    np.testing.assert_allclose(roller["normal"], scene["vertical"], atol=1e-12)
    rows = tables.modes(basis, drawn.seen)
    hidden = drawn.seen.index(False)
    assert rows[hidden]["title"].endswith(" Hz, rotations alone, which lines do not show")
