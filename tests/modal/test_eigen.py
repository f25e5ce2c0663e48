from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from bumpstop import (
    Beam,
    InputError,
    ModalBasis,
    PointMass,
    Rectangle,
    Structure,
    Support,
)
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.frame import rigid_motions

from ..hinged_beam import ALLOY, BAR, HINGE, IN_PLANE

Array = NDArray[np.float64]

STRIP = Rectangle(height=0.03, width=0.01)


def beam(supports: list[Support], elements: int = 10, section: Rectangle = BAR) -> Structure:
    return Structure(
        nodes={"A": (0, 0, 0), "B": (0.783, 0, 0)},
        beams=[Beam("AB", nodes=("A", "B"), elements=elements, material=ALLOY, section=section)],
        supports=supports,
    )


def frame(turn: Array | None = None) -> Structure:
    """A bent frame in space, held nowhere."""
    turn = np.eye(3) if turn is None else turn
    places = np.array([[0.0, 0, 0], [0.5, 0.1, 0.2], [0.6, 0.7, -0.1], [0.2, 0.5, 0.8]]) @ turn.T
    pairs = ["AB", "BC", "BD"]
    return Structure(
        nodes=dict(zip("ABCD", map(tuple, places), strict=True)),
        beams=[
            Beam(pair, nodes=(pair[0], pair[1]), elements=3, material=ALLOY, section=BAR)
            for pair in pairs
        ],
        masses=[PointMass("lump", node="D", mass=0.3)],
    )


def check_orthonormal(basis: ModalBasis) -> None:
    structure = basis.structure
    assert structure is not None
    shapes = basis.shapes
    modal_mass = shapes.T @ (structure.mass @ shapes)
    np.testing.assert_allclose(modal_mass, np.eye(len(basis.omega2)), atol=2e-12)
    modal_stiffness = shapes.T @ (structure.stiffness @ shapes)
    scale = np.sqrt(np.outer(basis.omega2, basis.omega2)) + basis.omega2.max() * 1e-3
    np.testing.assert_allclose((modal_stiffness - np.diag(basis.omega2)) / scale, 0.0, atol=1e-9)


def test_published_frequencies_of_sdnl32() -> None:
    """The published mesh: one node off the even spacing, and stretching not held."""
    nodes = {"A": 0.0, "F": 0.3915, "G": 0.4620, "H": 0.5481, "B": 0.7830}
    spans = [("A", "F", 5), ("F", "G", 1), ("G", "H", 1), ("H", "B", 3)]
    structure = Structure(
        nodes={node: (x, 0, 0) for node, x in nodes.items()},
        beams=[
            Beam(a + b, nodes=(a, b), elements=n, material=ALLOY, section=BAR) for a, b, n in spans
        ],
        supports=[
            Support(nodes="all", fixed=("dz", "drx", "dry")),
            Support(nodes="A", fixed=("dx", "dy")),
        ],
    )
    basis = ModalBasis.from_structure(structure, modes=10)
    published = [0, 85.407, 276.396, 575.673, 982.954, 1499.447, 1688.739, 2123.39, 2871.124]
    published.append(3721.058)
    np.testing.assert_allclose(basis.frequencies, published, atol=6e-4)
    assert np.abs(basis.row("B", "dx")).argmax() == 6


def test_sdnl32_modes_against_many_digits() -> None:
    """The assembled matrices of the clean model, solved with 40 digits."""
    import mpmath as mp

    structure = beam([IN_PLANE, HINGE])
    free = structure.free
    basis = ModalBasis.from_structure(structure, modes=10)
    with mp.workdps(40):
        stiffness, mass = (
            mp.matrix(matrix.to_dense()[np.ix_(free, free)].tolist())
            for matrix in (structure.stiffness, structure.mass)
        )
        inverse = mp.cholesky(mass) ** -1
        values, vectors = mp.eigsy(inverse * stiffness * inverse.T)
        tip = (inverse.T * vectors)[list(free).index(structure.dofs.index(("B", "dy"))), :]
        omega2 = np.array([float(value) for value in values])
        shapes = np.array([float(abs(value)) for value in tip])
    assert basis.omega2[0] == 0.0
    np.testing.assert_allclose(basis.omega2[1:], omega2[1:10], rtol=1e-12)
    np.testing.assert_allclose(np.abs(basis.row("B", "dy")), shapes[:10], rtol=1e-12)


def test_the_hinged_beam_turns_rigidly() -> None:
    structure = beam([IN_PLANE, HINGE])
    basis = ModalBasis.from_structure(structure, modes=21)
    assert basis.omega2[0] == 0.0
    assert np.all(basis.omega2[1:] > 0.0)
    turn = structure.rigid_field(rotation=(0.0, 0.0, 1.0))
    turn[np.setdiff1d(np.arange(len(turn)), structure.free)] = 0.0
    rate = basis.row("A", "drz")[0]
    np.testing.assert_allclose(basis.shapes[:, 0], rate * turn, rtol=3e-16)
    line = ALLOY.density * 0.783 * (BAR.area * 0.783**2 / 3 + BAR.inertia_z)
    assert rate == pytest.approx(1 / np.sqrt(line), rel=1e-13)
    check_orthonormal(basis)


def test_all_of_a_velocity_field_of_rotation_goes_to_the_rigid_mode() -> None:
    structure = beam([IN_PLANE, HINGE])
    basis = ModalBasis.from_structure(structure, modes=10)
    rates = basis.project_field(structure.rigid_field(rotation=(0.0, 0.0, -3.8)))
    assert abs(rates[0] * basis.row("B", "dy")[0] + 3.8 * 0.783) < 1e-14
    assert np.abs(rates[1:]).max() < 1e-14 * abs(rates[0])


@pytest.mark.parametrize(
    ("held", "rigid"),
    [
        ((), 6),
        (("dx", "dy", "dz"), 3),
        (("dx", "dy", "dz", "drx"), 2),
        (("drx", "dry", "drz"), 3),
        (DOFS, 0),
    ],
)
def test_count_of_rigid_modes_of_a_frame(held: tuple[str, ...], rigid: int) -> None:
    structure = frame()
    supports = [Support(nodes="C", fixed=held)] if held else []
    structure = Structure(
        nodes=structure.nodes, beams=structure.beams, masses=structure.masses, supports=supports
    )
    basis = ModalBasis.from_structure(structure, modes=10)
    assert np.count_nonzero(basis.omega2 == 0.0) == rigid
    assert basis.omega2[rigid] > 500.0
    strain = structure.stiffness @ basis.shapes[:, :rigid]
    assert np.abs(strain).max(initial=0.0) < 1e-14 * np.abs(structure.stiffness.values).max()
    check_orthonormal(basis)


def test_two_hinges_leave_a_turn_about_their_line() -> None:
    structure = frame()
    held = Support(nodes=("A", "C"), fixed=("dx", "dy", "dz"))
    structure = Structure(nodes=structure.nodes, beams=structure.beams, supports=[held])
    basis = ModalBasis.from_structure(structure, modes=3)
    assert list(basis.omega2 == 0.0) == [True, False, False]
    shape = basis.shapes[:, 0].reshape(-1, 6)
    line = np.subtract(structure.position("C"), structure.position("A"))
    turn = shape[0, 3:]
    np.testing.assert_allclose(np.cross(turn, line), 0.0, atol=1e-13 * np.abs(turn).max())
    place = structure.position("D")
    row = structure.mesh.names.index("D")
    np.testing.assert_allclose(shape[row, :3], np.cross(turn, place), atol=1e-13)


def test_rigid_modes_span_all_rigid_motions() -> None:
    structure = frame()
    basis = ModalBasis.from_structure(structure, modes=8)
    motions = rigid_motions(structure.mesh.positions, np.array([0.3, -0.2, 0.9]))
    shapes = basis.shapes[:, :6]
    weights = np.linalg.lstsq(motions, shapes, rcond=None)[0]
    np.testing.assert_allclose(motions @ weights, shapes, atol=1e-12)


def test_a_ball_is_one_rigid_mode() -> None:
    held = tuple(dof for dof in DOFS if dof != "dy")
    ball = Structure(
        nodes={"P": (3.0, 1.0, 0.0)},
        masses=[PointMass("ball", node="P", mass=4.0)],
        supports=[Support(nodes="P", fixed=held)],
    )
    basis = ModalBasis.from_structure(ball, modes=1)
    assert basis.omega2[0] == 0.0
    np.testing.assert_array_equal(basis.row("P", "dy"), [0.5])
    np.testing.assert_array_equal(basis.row("P", "dx"), [0.0])
    weight = basis.project_field(ball.rigid_field(translation=(0.0, -9.81, 0.0)))
    assert weight @ basis.row("P", "dy") == pytest.approx(-9.81)


def test_pieces_apart_have_their_own_rigid_modes() -> None:
    structure = Structure(
        nodes={"A": (0, 0, 0), "B": (0.783, 0, 0), "P": (2, 0, 0)},
        beams=[Beam("AB", nodes=("A", "B"), elements=4, material=ALLOY, section=BAR)],
        masses=[PointMass("ball", node="P", mass=4.0)],
        supports=[IN_PLANE, HINGE, Support(nodes="P", fixed=("drz",))],
    )
    basis = ModalBasis.from_structure(structure, modes=4, rigid_modes=2)
    assert list(basis.omega2 == 0.0) == [True, True, False, False]
    np.testing.assert_array_equal(basis.row("P", "dy"), [0.0, 0.5, 0.0, 0.0])
    assert basis.row("B", "dy")[1] == 0.0


def test_modes_of_equal_frequency_do_not_mix() -> None:
    """A square bar bends alike in both planes; each mode stays in one."""
    structure = beam([Support(nodes="A", fixed=DOFS)])
    basis = ModalBasis.from_structure(structure, modes=8)
    for mode in range(8):
        plane = np.abs(basis.shapes[:, mode].reshape(-1, 6)).max(axis=0) > 0.0
        assert tuple(plane) in {
            (False, True, False, False, False, True),
            (False, False, True, False, True, False),
            (False, False, False, True, False, False),
            (True, False, False, False, False, False),
        }


def test_flat_strip_bends_first_about_its_weak_axis() -> None:
    basis = ModalBasis.from_structure(
        beam([Support(nodes="A", fixed=DOFS)], section=STRIP), modes=2
    )
    assert basis.row("B", "dy")[0] == 0.0
    assert basis.row("B", "dz")[1] == 0.0
    assert basis.frequencies[1] / basis.frequencies[0] == pytest.approx(3.0, rel=5e-3)


@settings(max_examples=10, derandomize=True, deadline=None)
@given(angles=st.tuples(*[st.floats(-3.0, 3.0)] * 3))
def test_turning_a_frame_of_square_bars_changes_no_frequency(
    angles: tuple[float, float, float],
) -> None:
    turn = np.eye(3)
    for axis, angle in enumerate(angles):
        c, s = np.cos(angle), np.sin(angle)
        step = np.eye(3)
        i, j = (axis + 1) % 3, (axis + 2) % 3
        step[[i, i, j, j], [i, j, i, j]] = c, -s, s, c
        turn = step @ turn
    still = ModalBasis.from_structure(frame(), modes=12)
    turned = ModalBasis.from_structure(frame(turn), modes=12)
    np.testing.assert_array_equal(turned.omega2[:6], 0.0)
    np.testing.assert_allclose(turned.omega2[6:], still.omega2[6:], rtol=1e-8)


@pytest.mark.parametrize("scale", [1e-6, 1e3])
def test_rigid_modes_are_found_at_any_size(scale: float) -> None:
    """From micrometres to kilometres, with bars in proportion."""
    structure = frame()
    section = Rectangle(height=0.014 * scale, width=0.014 * scale)
    scaled = Structure(
        nodes={node: tuple(scale * x for x in place) for node, place in structure.nodes.items()},
        beams=[
            Beam(b.name, nodes=b.nodes, elements=3, material=ALLOY, section=section)
            for b in structure.beams
        ],
        supports=[Support(nodes="A", fixed=("dx", "dy", "dz"))],
    )
    basis = ModalBasis.from_structure(scaled, modes=4)
    assert list(basis.omega2 == 0.0) == [True, True, True, False]


def test_the_same_to_the_bit_every_time() -> None:
    first = ModalBasis.from_structure(frame(), modes=12)
    second = ModalBasis.from_structure(frame(), modes=12)
    np.testing.assert_array_equal(first.omega2, second.omega2)
    np.testing.assert_array_equal(first.shapes, second.shapes)


def test_largest_component_is_positive() -> None:
    shapes = ModalBasis.from_structure(frame(), modes=12).shapes
    assert np.all(shapes.max(axis=0) >= (1.0 - 1e-9) * np.abs(shapes).max(axis=0))


def test_more_modes_than_free_dofs() -> None:
    structure = beam([IN_PLANE, HINGE])
    assert len(ModalBasis.from_structure(structure, modes=21).omega2) == 21
    with pytest.raises(
        InputError, match=r"modes: more modes than free dofs \(got 22\); .* 21 free"
    ):
        ModalBasis.from_structure(structure, modes=22)


def test_no_free_dof_at_all() -> None:
    with pytest.raises(InputError, match="modes: there are none: nothing can move"):
        ModalBasis.from_structure(beam([Support(nodes="all", fixed=DOFS)]), modes=1)
