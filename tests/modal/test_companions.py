"""Static shapes, alone and beside modes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import eigh

import bumpstop as bs
from bumpstop.modal.static_shapes import StaticShapes

Array = NDArray[np.float64]

ALLOY = bs.Material(young_modulus=67e9, poisson_ratio=0.3, density=2400.0)
BAR = bs.Rectangle(height=0.014, width=0.02)
CLAMP = bs.Support(nodes="A", fixed=("dx", "dy", "dz", "drx", "dry", "drz"))
PLANE = bs.Support(nodes="all", fixed=("dx", "dz", "drx", "dry"))
HINGE = bs.Support(nodes="A", fixed="dy")
LENGTH = 0.783


def beam(*supports: bs.Support, elements: int = 6) -> bs.Structure:
    return bs.Structure(
        nodes={"A": (0, 0, 0), "B": (LENGTH, 0, 0)},
        beams=[bs.Beam("AB", nodes=("A", "B"), elements=elements, material=ALLOY, section=BAR)],
        supports=supports,
    )


def dense(model: bs.Structure) -> tuple[Array, Array]:
    stiffness, mass = (model.reduced(part).to_dense() for part in (model.stiffness, model.mass))
    return stiffness, mass


def place_rows(model: bs.Structure, places: list[tuple[str, str]]) -> Array:
    """Return the unit forces at places, on the free dofs, one a column."""
    return np.stack(
        [
            model.displacement_form(*place).of(np.eye(len(model.dofs)))[model.free]
            for place in places
        ],
        axis=1,
    )


PLACES = [("B", "dy"), ("AB@0.3", "dy"), ("AB.2", "drz"), ("B", "dx")]


def test_attachment_modes_are_columns_of_the_flexibility() -> None:
    model = beam(CLAMP)
    stiffness, _ = dense(model)
    shapes = StaticShapes(model).attachment(PLACES)
    wanted = np.linalg.solve(stiffness, place_rows(model, PLACES))
    np.testing.assert_allclose(shapes[model.free], wanted, rtol=1e-9, atol=1e-15)


def test_a_direction_is_the_sum_of_its_components() -> None:
    static = StaticShapes(beam(CLAMP))
    along = static.attachment([("B", (0.0, 3.0, 4.0))])
    parts = static.attachment([("B", "dy"), ("B", "dz")])
    np.testing.assert_allclose(along, parts @ [[0.6], [0.8]], atol=1e-12 * np.abs(along).max())


@pytest.mark.parametrize("supports", [(PLANE,), (PLANE, HINGE), ()])
def test_inertia_relief_leaves_the_flexible_part(supports: tuple[bs.Support, ...]) -> None:
    """Under a steady force the flexible modes of a free body stand still: their sum is it."""
    model = beam(*supports)
    stiffness, mass = dense(model)
    omega2, modes = eigh(stiffness, mass)
    flexible = omega2 > 1e-6 * omega2.max() / len(omega2) ** 2
    assert not flexible.all()
    forces = place_rows(model, [("B", "dy"), ("AB.2", "drz")])
    modes, omega2 = modes[:, flexible], omega2[flexible]
    wanted = modes @ ((modes.T @ forces) / omega2[:, np.newaxis])
    shapes = StaticShapes(model).attachment([("B", "dy"), ("AB.2", "drz")])
    size = np.abs(wanted).max()
    np.testing.assert_allclose(shapes[model.free], wanted, atol=1e-9 * size)


@pytest.mark.parametrize("elements", [6, 60])
@pytest.mark.parametrize("modes", [1, 3, 12])
def test_residual_flexibility_makes_static_response_exact(modes: int, elements: int) -> None:
    model = beam(CLAMP, elements=elements)
    stiffness, _ = dense(model)
    basis = bs.ModalBasis.from_structure(model, modes=modes, static_shapes=PLACES)
    rows = np.stack([basis.row(*place) for place in PLACES])
    forces = place_rows(model, PLACES)
    flexibility = forces.T @ np.linalg.solve(stiffness, forces)
    found = (rows / basis.omega2) @ rows.T
    np.testing.assert_allclose(found, flexibility, rtol=1e-9, atol=1e-12 * flexibility.max())


def test_static_shapes_of_a_buckled_beam() -> None:
    """Above Euler's load the straight beam is unstable, and still has its flexibility."""
    euler = math.pi**2 * 67e9 * (0.02 * 0.014**3 / 12) / LENGTH**2
    member = bs.Beam(
        "AB",
        nodes=("A", "B"),
        elements=8,
        material=ALLOY,
        section=BAR,
        tension=-1.5 * euler,
    )
    model = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (LENGTH, 0, 0)},
        beams=[member],
        supports=[PLANE, bs.Support(nodes=("A", "B"), fixed="dy")],
    )
    basis = bs.ModalBasis.from_structure(model, modes=3, static_shapes=[("AB@0.3", "dy")])
    assert basis.omega2[0] < 0.0 < basis.omega2[1]
    assert basis.remarks == ("the structure is unstable in mode 1: it moves away by itself",)
    stiffness, _ = dense(model)
    force = place_rows(model, [("AB@0.3", "dy")])[:, 0]
    wanted = force @ np.linalg.solve(stiffness, force)
    assert wanted < 0.0
    found = np.sum(basis.row("AB@0.3", "dy") ** 2 / basis.omega2)
    assert found == pytest.approx(wanted, rel=1e-9)


def test_a_force_that_moves_no_mass_is_refused() -> None:
    model = bs.Matrices(
        stiffness=np.array([[3.0, -1.0], [-1.0, 1.0]]),
        mass=np.diag([2.0, 0.0]),
        dofs=[("P", "dx"), ("Q", "dx")],
    )
    with pytest.raises(
        bs.InputError, match=r"static_shapes\[0\]: a force here has no mass to move"
    ):
        bs.ModalBasis.from_structure(model, modes=1, static_shapes=[("Q", "dx")])
    basis = bs.ModalBasis.from_vectors(model, np.ones((2, 1)))
    np.testing.assert_allclose(basis.omega2, 1.0, rtol=1e-14)


def test_modes_stay_as_they_are_beside_static_shapes() -> None:
    model = beam(PLANE, elements=20)
    alone = bs.ModalBasis.from_structure(model, modes=5)
    basis = bs.ModalBasis.from_structure(model, modes=5, static_shapes=[("B", "dy"), ("A", "dy")])
    np.testing.assert_array_equal(basis.omega2[:5], alone.omega2)
    np.testing.assert_array_equal(basis.shapes[:, :5], alone.shapes)
    assert basis.omega2[5:].min() > basis.omega2[:5].max()
    mass = basis.shapes.T @ (model.mass @ basis.shapes)
    np.testing.assert_allclose(mass, np.eye(7), atol=1e-11)
    stiffness = basis.shapes.T @ (model.stiffness @ basis.shapes)
    np.testing.assert_allclose(stiffness, np.diag(basis.omega2), atol=1e-9 * basis.omega2.max())
    assert basis.labels == (
        *(f"mode {i}" for i in range(1, 6)),
        "static shape of B.dy",
        "static shape of A.dy",
    )
    assert basis.dropped == ()


def test_amplitudes_are_those_of_each_static_shape() -> None:
    model = beam(PLANE, HINGE)
    places = [("B", "dy"), ("AB.3", "dy")]
    modes = bs.ModalBasis.from_structure(model, modes=4)
    basis = bs.ModalBasis.from_structure(model, modes=4, static_shapes=places)
    static = StaticShapes(model).attachment(places, beyond=modes.shapes)
    static /= np.sqrt(np.sum(static * (model.mass @ static), axis=0))
    amplitudes = np.array([0.0, 0.0, 2.0, 0.0, 3.0, -1.0])
    field = 2.0 * modes.shapes[:, 2] + static @ [3.0, -1.0]
    canonical = basis.canonical(amplitudes)
    np.testing.assert_allclose(basis.shapes @ canonical, field, atol=1e-11)
    np.testing.assert_allclose(basis.amplitudes(canonical), amplitudes, atol=1e-11)


def test_pseudo_modes_make_the_static_part_of_base_motion_exact() -> None:
    model = beam(CLAMP)
    stiffness, _ = dense(model)
    directions = {"dy": (0, 1, 0), "dz": (0, 0, 1)}
    basis = bs.ModalBasis.from_structure(model, modes=2, base_shapes=list(directions))
    assert basis.mass_rows is not None
    for direction in directions.values():
        base = model.rigid_field(translation=direction)
        response = basis.shapes @ ((basis.mass_rows @ base) / basis.omega2)
        wanted = np.linalg.solve(stiffness, (model.mass @ base)[model.free])
        size = np.abs(wanted).max()
        np.testing.assert_allclose(response[model.free], wanted, atol=1e-10 * size)
    shape = StaticShapes(model).base(["drz"])
    load = -(model.mass @ model.rigid_field(rotation=(0, 0, 1)))[model.free]
    np.testing.assert_allclose(
        shape[model.free, 0], np.linalg.solve(stiffness, load), atol=1e-10 * np.abs(shape).max()
    )


def test_constraint_modes_move_one_place_and_hold_the_others() -> None:
    model = beam(CLAMP)
    stiffness, _ = dense(model)
    shapes = StaticShapes(model).constraint(PLACES)[model.free]
    forces = place_rows(model, PLACES)
    np.testing.assert_allclose(forces.T @ shapes, np.eye(4), atol=1e-9)
    # What holds the shapes acts at the places alone.
    holding = stiffness @ shapes
    reactions, *_ = np.linalg.lstsq(forces, holding, rcond=None)
    np.testing.assert_allclose(forces @ reactions, holding, atol=1e-9 * np.abs(holding).max())


def test_constraint_modes_of_a_free_beam_are_straight() -> None:
    model = beam(PLANE)
    shapes = StaticShapes(model).constraint([("A", "dy"), ("B", "dy")])
    rows = [model.dofs.index((node, "dy")) for node in ("A", "AB.2", "B")]
    along = np.array([0.0, 1.0 / 3.0, 1.0])
    np.testing.assert_allclose(shapes[rows].T, [1 - along, along], atol=1e-11)


def test_constraint_shapes_and_static_shapes_span_the_same() -> None:
    model = beam(CLAMP)
    places = PLACES[:3]
    static = bs.ModalBasis.from_structure(model, modes=4, static_shapes=places)
    held = bs.ModalBasis.from_structure(model, modes=4, constraint_shapes=places)
    np.testing.assert_allclose(static.omega2, held.omega2, rtol=1e-8)
    both = bs.ModalBasis.from_structure(
        model, modes=4, static_shapes=places, constraint_shapes=places
    )
    assert len(both.omega2) == 7
    assert both.dropped == tuple(
        f"constraint shape of {node}.{dof} is left out: it depends on those before it"
        for node, dof in places
    )


def test_what_adds_nothing_is_left_out_with_a_word() -> None:
    model = beam(PLANE)
    twice = bs.ModalBasis.from_structure(model, modes=3, static_shapes=[("B", "dy"), ("B", "dy")])
    assert len(twice.omega2) == 4
    assert twice.dropped == ("static shape of B.dy is left out: it depends on those before it",)
    full = bs.ModalBasis.from_structure(model, modes="all", static_shapes=[("B", "dy")])
    assert len(full.omega2) == len(model.free)
    assert full.dropped == ("static shape of B.dy is left out: the modes have all of it",)
    along = bs.ModalBasis.from_structure(model, modes=3, base_shapes=["dy"])
    assert along.dropped == ("base acceleration along dy is left out: it is zero",)


def test_damping_of_static_shapes() -> None:
    model = beam(CLAMP)

    def ratios(**damping: Any) -> list[float]:
        basis = bs.ModalBasis.from_structure(model, modes=2, static_shapes=[("B", "dy")], **damping)
        return list(basis.damping_ratio)

    assert ratios() == [0.0] * 3
    assert ratios(damping=0.01) == [0.01] * 3
    assert ratios(damping=0.01, static_damping=0.5) == [0.01, 0.01, 0.5]
    assert ratios(damping=[0.01, 0.02], static_damping=0.5) == [0.01, 0.02, 0.5]
    with pytest.raises(bs.InputError, match="static_damping: is missing; with a list"):
        ratios(damping=[0.01, 0.02])
    with pytest.raises(bs.InputError, match="static_damping: must not be negative"):
        ratios(static_damping=-0.1)
    with pytest.raises(bs.InputError, match="one for each of the 2 modes"):
        ratios(damping=[0.01, 0.02, 0.03], static_damping=0.1)


@pytest.mark.parametrize(
    ("places", "says"),
    [
        ("B", r"static_shapes: must be a list of nodes"),
        (["B"], r"static_shapes\[0\]: must be a node and a dof"),
        ([("B", "dy"), ("C", "dy")], r"static_shapes\[1\]: unknown node \(got 'C'\)"),
        ([("B", "y")], r"static_shapes\[0\]: unknown dof \(got 'y'\)"),
        ([("A", "dy")], r"static_shapes\[0\]: nothing can move here \(got 'A dy'\)"),
        ([("B", (0, 0, 0))], r"static_shapes\[0\]: a direction must have a length"),
        ([("B", (0, float("nan"), 1))], r"static_shapes\[0\]: must be finite"),
        ([("B", (0, 1))], r"static_shapes\[0\]: must be a list of 3 numbers"),
        ([("AB@1", "dy")], r"static_shapes\[0\]: "),
    ],
)
def test_bad_places_are_refused(places: Any, says: str) -> None:
    with pytest.raises(bs.InputError, match=says):
        bs.ModalBasis.from_structure(beam(CLAMP), modes=2, static_shapes=places)


def test_bad_directions_and_constraints_are_refused() -> None:
    model = beam(CLAMP)
    with pytest.raises(bs.InputError, match="base_shapes: unknown direction"):
        bs.ModalBasis.from_structure(model, modes=2, base_shapes=["x"])
    with pytest.raises(bs.InputError, match="base_shapes: must be a list"):
        bs.ModalBasis.from_structure(model, modes=2, base_shapes="dy")
    with pytest.raises(bs.InputError, match=r"constraint_shapes: cannot move while .*B.dy"):
        bs.ModalBasis.from_structure(model, modes=2, constraint_shapes=[("B", "dy"), ("B", "dy")])


def test_a_point_mass_in_space_has_no_flexibility() -> None:
    point = bs.Structure(
        nodes={"P": (0, 0, 0)},
        masses=[bs.PointMass("m", node="P", mass=2.0)],
        supports=[bs.Support(nodes="P", fixed=("drx", "dry", "drz"))],
    )
    basis = bs.ModalBasis.from_structure(point, modes=3, static_shapes=[("P", "dx")])
    assert basis.dropped == ("static shape of P.dx is left out: it is zero",)
    np.testing.assert_allclose(StaticShapes(point).constraint([("P", "dy")])[:3, 0], [0, 1, 0])


@pytest.mark.parametrize("modes", ["all", 36])
def test_the_complete_basis_has_every_mode(modes: int | str) -> None:
    model = beam(CLAMP)
    basis = bs.ModalBasis.from_structure(model, modes=modes)
    np.testing.assert_allclose(basis.omega2, eigh(*dense(model), eigvals_only=True), rtol=1e-8)
    # Completeness: the shapes and the mass matrix invert each other.
    assert basis.mass_rows is not None
    whole = basis.shapes[model.free] @ basis.mass_rows[:, model.free]
    np.testing.assert_allclose(whole, np.eye(36), atol=1e-9)
