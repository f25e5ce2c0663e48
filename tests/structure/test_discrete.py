"""Masses, springs and bearings against rigid-body mechanics and by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from bumpstop import (
    Beam,
    Bearing,
    InputError,
    Material,
    ModalBasis,
    PointMass,
    Rectangle,
    Spring,
    Structure,
    Support,
)
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.frame import rigid_motions

Array = NDArray[np.float64]
TURNED = ((0.0, 1.0, 0.0), (0.0, 0.5, 2.0))  # local x is Y, y is Z, z is X
few = settings(max_examples=20, derandomize=True, deadline=None)
number = st.floats(-2.0, 2.0)
vectors = st.tuples(number, number, number)


def body(**said: Any) -> Structure:
    """One rigid body on a node, free in space."""
    return Structure(
        nodes={"P": (0.3, -0.2, 0.5)},
        masses=[PointMass("body", **{"node": "P", "mass": 2.0, **said})],
    )


def pair(*parts: Spring | Bearing, gap: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Structure:
    """Two bodies of unit mass and inertia with parts between them."""
    masses = [PointMass(n, node=n, mass=1.0, inertia=(1.0, 1.0, 1.0)) for n in ("P", "Q")]
    return Structure(
        nodes={"P": (0.3, -0.2, 0.5), "Q": tuple(np.add((0.3, -0.2, 0.5), gap))},
        masses=masses,
        springs=[part for part in parts if isinstance(part, Spring)],
        bearings=[part for part in parts if isinstance(part, Bearing)],
    )


@few
@given(offset=vectors, velocity=vectors, rate=vectors)
def test_kinetic_energy_of_a_body_off_its_node(
    offset: tuple[float, ...], velocity: tuple[float, ...], rate: tuple[float, ...]
) -> None:
    inertia = np.array([[3.0, 0.2, -0.1], [0.2, 2.0, 0.3], [-0.1, 0.3, 4.0]])
    structure = body(inertia=inertia, offset=offset)
    motion = np.array([*velocity, *rate])
    centre = np.array(velocity) + np.cross(rate, offset)
    expected = 2.0 * centre @ centre + np.array(rate) @ inertia @ np.array(rate)
    assert motion @ (structure.mass @ motion) == pytest.approx(expected, rel=1e-12, abs=1e-14)


def test_inertia_in_three_six_or_nine_numbers() -> None:
    nine = [[3.0, 0.2, -0.1], [0.2, 2.0, 0.3], [-0.1, 0.3, 4.0]]
    for given_inertia, expected in (
        ((3.0, 2.0, 4.0), np.diag([3.0, 2.0, 4.0])),
        ((3.0, 2.0, 4.0, 0.2, 0.3, -0.1), np.array(nine)),
        (nine, np.array(nine)),
    ):
        mass = body(inertia=given_inertia).mass.to_dense()
        np.testing.assert_array_equal(mass[3:, 3:], expected)
        np.testing.assert_array_equal(mass[:3], 2.0 * np.eye(6)[:3])


def test_inertia_in_axes_of_its_own() -> None:
    mass = body(inertia=(3.0, 2.0, 4.0), axes=TURNED).mass.to_dense()
    np.testing.assert_allclose(mass[3:, 3:], np.diag([4.0, 3.0, 2.0]), atol=1e-15)


def test_a_plain_mass_has_no_rotations() -> None:
    assert [body().dofs[i][1] for i in body().free] == ["dx", "dy", "dz"]


def test_inertia_alone_may_turn() -> None:
    wheel = Structure(
        nodes={"P": (0, 0, 0)},
        masses=[PointMass("wheel", node="P", mass=0.0, inertia=(0.5, 0.5, 0.5))],
        springs=[Spring("hub", node="P", stiffness=(0, 0, 0, 8.0, 2.0, 18.0))],
        supports=[Support(nodes="P", fixed=("dx", "dy", "dz"))],
    )
    frequencies = ModalBasis.from_structure(wheel, modes=3).frequencies
    np.testing.assert_allclose(frequencies * 2 * np.pi, [2.0, 4.0, 6.0], rtol=1e-14)


def test_a_gyroscope_precesses() -> None:
    """Free of moments, a disc's axis turns at spin J / I: +- i times that are eigenvalues."""
    disc = body(inertia=(0.04, 0.025, 0.025), spin=300.0, axes=((0, 0, 1), (1, 0, 0)))
    mass, gyroscopic = disc.mass.to_dense(), disc.gyroscopic.to_dense()
    np.testing.assert_array_equal(gyroscopic, -gyroscopic.T)
    rates = np.linalg.eigvals(-np.linalg.solve(mass, gyroscopic))
    expected = 300.0 * 0.04 / 0.025
    np.testing.assert_allclose(np.sort(np.abs(rates))[-2:], [expected] * 2, rtol=1e-12)


def test_a_gyroscope_turns_the_right_way() -> None:
    """To pitch a wheel that spins about +X, about +Y, takes a moment about -Z."""
    wheel = body(inertia=(0.04, 0.02, 0.02), spin=10.0)
    pitching = np.array([0, 0, 0, 0, 1.0, 0])
    np.testing.assert_allclose(wheel.gyroscopic @ pitching, [0, 0, 0, 0, 0, -0.4], atol=1e-15)


def test_a_chain_of_two_springs() -> None:
    """Two equal masses and springs: omega2 = (3 -+ sqrt 5) / 2 k / m."""
    line = {"A": (0, 0, 0), "B": (0.5, 0, 0), "C": (1.2, 0, 0)}
    chain = Structure(
        nodes=line,
        masses=[PointMass("b", node="B", mass=2.0), PointMass("c", node="C", mass=2.0)],
        springs=[
            Spring("ab", node="A", other="B", stiffness=800.0),
            Spring("bc", node="B", other="C", stiffness=800.0, damping=3.0),
        ],
        supports=[Support(nodes="A", fixed=DOFS), Support(nodes="all", fixed=("dy", "dz"))],
    )
    omega2 = ModalBasis.from_structure(chain, modes=2).omega2
    golden = np.array([3.0 - math.sqrt(5.0), 3.0 + math.sqrt(5.0)]) / 2.0
    np.testing.assert_allclose(omega2, golden * 400.0, rtol=1e-14)
    dampers = chain.damping.restricted(chain.free).to_dense()
    np.testing.assert_array_equal(dampers, [[3.0, -3.0], [-3.0, 3.0]])


@few
@given(gap=vectors.filter(lambda v: np.linalg.norm(v) > 0.1), about=vectors)
def test_bodies_that_move_together_strain_no_spring(
    gap: tuple[float, float, float], about: tuple[float, float, float]
) -> None:
    full = np.arange(36.0).reshape(6, 6)
    structure = pair(
        Spring("along", node="P", other="Q", stiffness=3.0),
        Spring("each", node="P", other="Q", stiffness=(1, 2, 3, 4, 5, 6), axes=TURNED),
        Spring("full", node="P", other="Q", stiffness=full + full.T, damping=np.eye(6)),
        Bearing("film", node="P", other="Q", stiffness=[[1.0, 2.0], [-3.0, 4.0]], damping=2.0),
        gap=gap,
    )
    motions = rigid_motions(structure.mesh.positions, np.array(about))
    for matrix in (structure.stiffness, structure.damping, structure.circulatory):
        forces = matrix @ motions
        scale = np.abs(matrix.values).max() * np.abs(motions).max()
        np.testing.assert_allclose(forces, 0.0, atol=1e-13 * scale)


def test_springs_by_axes() -> None:
    along = Spring("s", node="P", stiffness=5.0, axes=TURNED)
    each = Spring("s", node="P", stiffness=(1, 2, 3, 4, 5, 6), axes=TURNED)
    for spring, diagonal in ((along, [0, 5, 0, 0, 0, 0]), (each, [3, 1, 2, 6, 4, 5])):
        structure = Structure(
            nodes={"P": (1, 2, 3)},
            masses=[PointMass("m", node="P", mass=1.0, inertia=(1, 1, 1))],
            springs=[spring],
        )
        stiffness = structure.stiffness.to_dense()
        np.testing.assert_allclose(stiffness, np.diag(diagonal), atol=1e-15)


def test_a_spring_along_the_line_between_its_nodes() -> None:
    stiffness = pair(
        Spring("s", node="P", other="Q", stiffness=25.0), gap=(0.3, 0.0, 0.4)
    ).stiffness.to_dense()
    line = np.array([0.6, 0.0, 0.8])
    np.testing.assert_allclose(stiffness[:3, 6:9], -25.0 * np.outer(line, line), atol=1e-14)
    np.testing.assert_array_equal(stiffness[3:6], 0.0)


def test_a_matrix_of_both_nodes_is_taken_as_it_is() -> None:
    random = np.random.default_rng(5).normal(size=(12, 12))
    matrix = random @ random.T
    structure = pair(
        Spring("s", node="P", other="Q", stiffness=matrix.tolist(), damping=matrix), gap=(1, 0, 0)
    )
    np.testing.assert_allclose(structure.stiffness.to_dense(), matrix, rtol=1e-14)
    np.testing.assert_allclose(structure.damping.to_dense(), matrix, rtol=1e-14)


def test_a_bearing_is_split_in_its_symmetric_and_skew_parts() -> None:
    film = Bearing(
        "film",
        node="P",
        axis=(0, 0, 2.0),  # local y is Y, z is -X
        stiffness=[[4.0, 3.0], [-1.0, 5.0]],
        damping=[[7.0, 0.5], [-0.5, 9.0]],
    )
    rotor = Structure(
        nodes={"P": (0, 0, 0)},
        masses=[PointMass("m", node="P", mass=1.0)],
        bearings=[film],
    )
    symmetric, skew = (m.to_dense()[:2, :2] for m in (rotor.stiffness, rotor.circulatory))
    np.testing.assert_array_equal(symmetric, [[5.0, -1.0], [-1.0, 4.0]])
    np.testing.assert_array_equal(skew, [[0.0, 2.0], [-2.0, 0.0]])
    symmetric, skew = (m.to_dense()[:2, :2] for m in (rotor.damping, rotor.gyroscopic))
    np.testing.assert_array_equal(symmetric, [[9.0, 0.0], [0.0, 7.0]])
    np.testing.assert_array_equal(skew, [[0.0, 0.5], [-0.5, 0.0]])


def test_grounded_springs_hold_a_beam() -> None:
    """A stiff bar on two springs: it bounces and rocks, and nothing of it is a rigid mode."""
    steel = Material(young_modulus=210e12, poisson_ratio=0.3, density=7800.0)
    bar = Rectangle(height=0.1, width=0.1)
    structure = Structure(
        nodes={"A": (0, 0, 0), "B": (2.0, 0, 0)},
        beams=[Beam("AB", nodes=("A", "B"), elements=4, material=steel, section=bar)],
        springs=[Spring(n, node=n, stiffness=(0, 1e5, 0, 0, 0, 0)) for n in ("A", "B")],
        supports=[Support(nodes="all", fixed=("dx", "dz", "drx", "dry"))],
    )
    omega2 = ModalBasis.from_structure(structure, modes=2).omega2
    mass = 7800.0 * 0.01 * 2.0
    inertia = mass * 2.0**2 / 12 + 7800.0 * 2.0 * bar.inertia_z
    np.testing.assert_allclose(omega2, [2e5 / mass, 2e5 / inertia], rtol=1e-5)


MASS: dict[str, Any] = {"node": "P", "mass": 1.0}
BAD_MASSES: list[tuple[dict[str, Any], str]] = [
    ({"mass": -1.0}, "mass: must not be negative"),
    ({"mass": 0.0}, "mass: must be positive"),
    ({"mass": math.nan}, "mass: must be finite"),
    ({"inertia": (1.0, 2.0)}, "inertia: must be three or six numbers"),
    ({"inertia": "round"}, "inertia: must be three or six numbers"),
    ({"inertia": (1.0, -2.0, 1.0)}, "inertia: no moment of inertia may be negative"),
    ({"inertia": (1.0, 1.0, 1.0, 9.0, 0, 0)}, "inertia: no moment of inertia may be negative"),
    ({"inertia": [[1, 2, 3], [4, 5, 6], [7, 8, 9]]}, "inertia: must be symmetric; row 1, column 3"),
    ({"inertia": [[1, 2], [4, 5], [7, 8]]}, "inertia: must be a matrix of 3 x 3 numbers"),
    ({"offset": (0.0, 1.0)}, "offset: must be a list of 3 numbers"),
    ({"axes": ((1, 0, 0), (2, 0, 0))}, "axes: the two vectors must not be zero or parallel"),
    ({"axes": (1, 0, 0)}, "axes: must be two vectors"),
    ({"spin": 3.0}, "inertia: what spins needs inertia"),
    ({"spin": 3.0, "inertia": (1.0, 2.0, 3.0)}, "inertia: what spins must have the same inertia"),
]


@pytest.mark.parametrize(("changes", "message"), BAD_MASSES)
def test_bad_masses_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=f"^{message}"):
        PointMass("m", **{**MASS, **changes})


BAD_SPRINGS: list[tuple[dict[str, Any], str]] = [
    ({}, "stiffness: a spring needs stiffness or damping"),
    ({"stiffness": 3.0}, "stiffness: one number needs a direction"),
    ({"stiffness": "3"}, "stiffness: must be a number"),
    ({"stiffness": "3", "other": "Q"}, "stiffness: must be a number"),
    ({"stiffness": (1.0, 2.0)}, "stiffness: must be a number, six numbers or a symmetric matrix"),
    ({"stiffness": (1, 2, 3, 4, 5, math.inf)}, "stiffness: must be finite"),
    ({"stiffness": np.ones((6, 5))}, "stiffness: must be a matrix of 6 x 6 numbers"),
    ({"stiffness": np.eye(12)}, "stiffness: must be a matrix of 6 x 6 numbers"),
    ({"damping": np.triu(np.ones((6, 6)))}, "damping: must be symmetric"),
    ({"stiffness": 1.0, "other": "P"}, "other: must be another node"),
    ({"stiffness": 1.0, "axes": ((0, 0, 0), (1, 0, 0))}, "axes: the two vectors"),
]


@pytest.mark.parametrize(("changes", "message"), BAD_SPRINGS)
def test_bad_springs_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=f"^{message}"):
        Spring("s", **{"node": "P", **changes})


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"axis": (0, 0, 0)}, "axis: must not be zero"),
        ({"stiffness": [[1.0, 2.0]]}, "stiffness: must be a matrix of 2 x 2 numbers"),
        ({"stiffness": "stiff"}, "stiffness: must be a number"),
        ({"damping": [[1.0, 2.0], [3.0, math.nan]]}, "damping: must be finite"),
        ({"other": "P"}, "other: must be another node"),
    ],
)
def test_bad_bearings_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=f"^{message}"):
        Bearing("b", **{"node": "P", "stiffness": 1.0, **changes})


def test_parts_name_their_nodes() -> None:
    with pytest.raises(InputError, match=r"^springs.s.other: unknown node"):
        pair(Spring("s", node="P", other="R", stiffness=1.0))
    with pytest.raises(InputError, match=r"^bearings.b.node: unknown node"):
        pair(Bearing("b", node="R", stiffness=1.0))
    with pytest.raises(InputError, match=r"^springs.s.other: has no direction"):
        pair(Spring("s", node="P", other="Q", stiffness=1.0))
    with pytest.raises(InputError, match=r"^springs: this name is used twice"):
        pair(*[Spring("s", node="P", stiffness=(1, 1, 1, 1, 1, 1))] * 2)


@pytest.mark.parametrize(
    "inertia",
    [
        (1.0, 1.0, 5.0),
        (0.0, 1.0, 2.0),
        (1.0, 1.0, 2.0001),
        (3.0, 3.0, 1.0, 2.5, 0.0, 0.0),  # principal moments 5.5, 0.5 and 1
    ],
)
def test_moments_of_inertia_of_no_body_are_refused(inertia: tuple[float, ...]) -> None:
    with pytest.raises(InputError, match=r"^inertia: no body has principal moments of .*each is"):
        PointMass("m", node="P", mass=1.0, inertia=inertia)


@given(st.lists(st.floats(0.1, 10.0), min_size=9, max_size=9), st.floats(1e-6, 1e6))
def test_moments_of_inertia_of_every_body_are_taken(places: list[float], scale: float) -> None:
    """Three points of mass make a body, flat ones too; the sum is then exact but for rounding."""
    points = np.array(places).reshape(3, 3)
    points -= points.mean(axis=0)
    tensor = scale * sum((r @ r) * np.eye(3) - np.outer(r, r) for r in points)
    assert PointMass("m", node="P", mass=1.0, inertia=tensor).remarks == ()


def test_inertia_about_one_axis_alone_is_told() -> None:
    """Decks of beams have it, for the one rotation that matters."""
    wheel = PointMass("wheel", node="P", mass=2.0, inertia=(0.3, 0.0, 0.0))
    (line,) = wheel.remarks
    assert line == "mass 'wheel' has inertia about one axis alone, which no body has"
    structure = Structure(nodes={"P": (0, 0, 0)}, masses=[wheel])
    assert ModalBasis.from_structure(structure, modes=1).remarks[-1] == line


def test_a_negative_spring_is_told() -> None:
    """It may be meant, as with a magnet; the modes say what it does."""
    with pytest.raises(InputError, match=r"stiffness: is negative, and one number needs a direct"):
        Spring("magnet", node="P", stiffness=-100.0)
    magnet = Spring("magnet", node="P", stiffness=(-100.0, 0.0, 0.0, 0.0, 0.0, 0.0), damping=None)
    assert magnet.remarks == ("spring 'magnet' has negative stiffness: it pushes away",)
    assert Spring("s", node="P", damping=-np.eye(6)).remarks == (
        "spring 's' has negative damping: it feeds energy",
    )
    assert Spring("s", node="P", other="Q", stiffness=5.0, damping=0.0).remarks == ()
    pulled = Structure(
        nodes={"P": (0, 0, 0)},
        masses=[PointMass("m", node="P", mass=1.0)],
        springs=[magnet],
        supports=[Support(nodes="P", fixed=("dy", "dz"))],
    )
    assert ModalBasis.from_structure(pulled, modes=1).remarks == (
        "the structure is unstable in mode 1: it moves away by itself",
        "spring 'magnet' has negative stiffness: it pushes away",
    )
