from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from bumpstop import InputError, Matrices, ModalBasis, NodalForce, Structure
from bumpstop.arguments import FloatArray
from bumpstop.structure.dofs import DOFS, Dof
from bumpstop.structure.model import LinearModel

DX = [("P", "dx"), ("Q", "dx")]
SPRING = np.array([[2.0, -2.0], [-2.0, 2.0]])
MASS = np.eye(2)

Cantilever = Callable[..., Structure]


def pair(**changes: Any) -> Matrices:
    given_by_name: dict[str, Any] = {"stiffness": SPRING, "mass": MASS, "dofs": DX} | changes
    return Matrices(**given_by_name)


def of(structure: Structure, *, fixed: bool = True, positions: bool = True) -> Matrices:
    held = np.setdiff1d(np.arange(len(structure.dofs)), structure.free)
    mesh = structure.mesh
    return Matrices(
        stiffness=structure.stiffness.to_scipy(),
        mass=structure.mass.to_scipy(),
        dofs=structure.dofs,
        positions=dict(zip(mesh.names, mesh.positions, strict=True)) if positions else None,
        fixed=[structure.dofs[i] for i in held] if fixed else (),
    )


def test_they_are_a_linear_model() -> None:
    model: LinearModel = pair()
    assert model.dofs == tuple(DX)
    assert not len(model.damping.values)
    assert not len(model.gyroscopic.values)
    assert not len(model.circulatory.values)


@pytest.mark.parametrize(
    "form",
    [np.asarray, np.ndarray.tolist, sp.csr_matrix, sp.coo_array, sp.csc_array, sp.bsr_array],
    ids=lambda form: form.__name__,
)
def test_any_form_of_a_matrix_will_do(form: Callable[[FloatArray], Any]) -> None:
    model = pair(stiffness=form(SPRING))
    np.testing.assert_array_equal(model.stiffness.to_dense(), SPRING)


def test_fixed_dofs_are_left_out() -> None:
    model = pair(fixed=[("P", "dx")])
    assert model.free.tolist() == [1]
    assert model.reduced(model.stiffness).to_dense().tolist() == [[2.0]]
    np.testing.assert_array_equal(model.expansion.to_dense(), [[0.0], [1.0]])
    assert model.rigid_shapes().shape == (1, 0)


def test_rounding_of_symmetry_is_evened_out() -> None:
    uneven = SPRING.copy()
    uneven[0, 1] *= 1.0 + 1e-14
    stiffness = pair(stiffness=uneven).stiffness.to_dense()
    assert stiffness[0, 1] == stiffness[1, 0]
    assert stiffness[0, 1] == pytest.approx(-2.0, rel=1e-14)


REFUSED = [
    ({"stiffness": np.ones((2, 3))}, "stiffness: must be square, not 2 x 3"),
    ({"mass": np.eye(3)}, "mass: is 3 x 3, but there are 2 dofs"),
    (
        {"stiffness": [[2.0, -2.0], [-1.5, 2.0]]},
        r"stiffness: must be symmetric, but is -2 at \(P.dx, Q.dx\) and -1.5 at its mirror",
    ),
    ({"gyroscopic": np.eye(2)}, r"gyroscopic: must be skew-symmetric, but is 1 at \(P.dx, P.dx\)"),
    ({"stiffness": [[2.0, np.nan], [np.nan, 2.0]]}, r"stiffness: must be finite at \(Q.dx, P.dx\)"),
    ({"mass": [[1.0, 0.0], [0.0, -1.0]]}, r"mass: must not be negative at Q.dx \(got -1.0\)"),
    (
        {"mass": np.diag([1.0, 0.0]), "damping": SPRING},
        "nodes.Q: dx is moved by a damper, but has no mass",
    ),
    ({"mass": np.zeros((2, 2))}, "mass: is zero everywhere: nothing has inertia"),
    (
        {"mass": np.diag([1.0, 0.0]), "fixed": [("P", "dx")]},
        "nothing that can move has mass",
    ),
    (
        {"stiffness": -SPRING, "mass": np.diag([1.0, 0.0])},
        "nodes.Q: dx is pushed away by a negative stiffness, but has no mass",
    ),
    ({"stiffness": np.zeros((0, 0))}, "stiffness: is 0 x 0, but there are 2 dofs"),
    ({"stiffness": SPRING + 1j}, "stiffness: must be real, not complex"),
    ({"stiffness": [[1.0], [1.0, 2.0]]}, "stiffness: must be a matrix"),
    ({"stiffness": [1.0, 2.0]}, "stiffness: must be a matrix"),
    ({"stiffness": [["a", "b"], ["c", "d"]]}, "stiffness: must hold numbers"),
    ({"dofs": [("P", "dx"), ("P", "dx")]}, r"dofs\[1\]: the same as dofs\[0\]"),
    ({"dofs": [("P", "dx"), ("P", "ux")]}, r"dofs\[1\]: unknown dof \(got 'ux'\)"),
    ({"dofs": [("P", "dx"), "P"]}, r"dofs\[1\]: must be a node's name and a dof"),
    ({"dofs": []}, "dofs: must name at least one dof"),
    ({"fixed": [("R", "dx")]}, r"fixed\[0\]: unknown node \(got 'R'\)"),
    ({"fixed": [("P", "dy")]}, r"fixed\[0\]: the matrices have no such dof \(got 'dy'\)"),
    ({"positions": {"P": (0.0, 1.0)}}, r"positions.P: must be a list of 3 numbers"),
    ({"positions": [1.0]}, "positions: must map names of nodes"),
    ({"accuracy": 0.0}, "accuracy: must be positive"),
]


@pytest.mark.parametrize(("changes", "message"), REFUSED, ids=[line for _, line in REFUSED])
def test_what_is_wrong_is_said_in_one_line(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        pair(**changes)


def test_a_matrix_that_is_not_positive_is_refused_as_mass() -> None:
    with pytest.raises(InputError, match=r"mass: must not be negative, but is for some motion"):
        pair(mass=[[1.0, 2.0], [2.0, 1.0]])


def test_unknown_places_are_named() -> None:
    model = pair(positions={"P": (1.0, 2.0, 3.0)})
    assert model.position("P") == (1.0, 2.0, 3.0)
    with pytest.raises(InputError, match=r"the position of this node is not known"):
        model.position("Q")
    with pytest.raises(InputError, match="unknown node"):
        model.displacement_form("R", "dx")
    with pytest.raises(InputError, match=r"the matrices have no such dof .*known at 'P': dx"):
        model.displacement_form("P", "dy")
    with pytest.raises(InputError, match=r"the position of this node is not known .got 'Q'."):
        model.rigid_field(rotation=(0.0, 0.0, 1.0))


def test_what_has_no_mass_follows_or_is_left_out() -> None:
    """A mass on two springs in line, between which nothing has mass, and a dof of nobody."""
    stiffness = np.zeros((3, 3))
    stiffness[:2, :2] = [[3.0 + 2.0, -2.0], [-2.0, 2.0]]
    model = Matrices(
        stiffness=stiffness,
        mass=np.diag([0.0, 4.0, 0.0]),
        dofs=[("joint", "dx"), ("P", "dx"), ("P", "drx")],
    )
    assert model.free.tolist() == [1]
    np.testing.assert_allclose(model.expansion.to_dense(), [[0.4], [1.0], [0.0]])
    basis = ModalBasis.from_structure(model, modes="all")
    np.testing.assert_allclose(basis.omega2, [(3.0 * 2.0 / 5.0) / 4.0])
    push = NodalForce("push", node="joint", force=(1, 0, 0))
    with pytest.raises(InputError, match=r"a force here has no mass to move .got 'joint'."):
        push.modal_force(basis)


def test_lumped_masses_without_rotary_inertia(cantilever: Cantilever) -> None:
    """As SciPy finds by condensing the rotations itself."""
    structure = cantilever(elements=6)
    mass = np.diag([1.0, 1.0, 1.0, 0.0, 0.0, 0.0] * len(structure.mesh.names))
    clamped = of(structure)
    model = Matrices(
        stiffness=clamped.stiffness,
        mass=mass,
        dofs=clamped.dofs,
        positions=clamped.positions,
        fixed=clamped.fixed,
    )
    stiffness = structure.stiffness.to_dense()
    moves = np.flatnonzero([dof[:2] != "dr" and node != "A" for node, dof in model.dofs])
    turns = np.flatnonzero([dof[:2] == "dr" and node != "A" for node, dof in model.dofs])
    follow = np.linalg.solve(stiffness[np.ix_(turns, turns)], stiffness[np.ix_(turns, moves)])
    schur = stiffness[np.ix_(moves, moves)] - stiffness[np.ix_(moves, turns)] @ follow
    expected = scipy.linalg.eigh(schur, eigvals_only=True)[:8]
    np.testing.assert_allclose(
        ModalBasis.from_structure(model, modes=8).omega2, expected, rtol=1e-8
    )


@pytest.mark.parametrize("positions", [True, False])
def test_a_free_frame_has_six_rigid_motions(cantilever: Cantilever, positions: bool) -> None:
    structure = cantilever(tip=(0.4, 0.3, 1.2), elements=5)
    model = of(structure, fixed=False, positions=positions)
    shapes = model.rigid_shapes()
    assert shapes.shape == (36, 6)
    assert np.linalg.matrix_rank(shapes) == 6
    forces = structure.stiffness.to_dense() @ shapes
    assert np.abs(forces).max() <= 1e-9 * np.abs(structure.stiffness.values).max()


def test_a_clamped_frame_has_none(cantilever: Cantilever) -> None:
    assert of(cantilever()).rigid_shapes().shape[1] == 0
    assert of(cantilever(), positions=False).rigid_shapes().shape[1] == 0


def test_a_soft_spring_to_the_ground_is_no_rounding(cantilever: Cantilever) -> None:
    structure = cantilever(elements=4)
    held = structure.stiffness.to_scipy().tolil()
    stiff = float(np.abs(structure.stiffness.values).max())
    number = structure.dofs.index(("B", "dy"))
    held[number, number] += 1e-10 * stiff
    loose = of(structure, fixed=False)
    model = Matrices(
        stiffness=held.tocsc(), mass=loose.mass, dofs=loose.dofs, positions=loose.positions
    )
    assert model.rigid_shapes().shape[1] == 5


def test_rigid_motions_come_from_geometry(cantilever: Cantilever) -> None:
    structure = cantilever(elements=6)
    hinged = Matrices(
        stiffness=structure.stiffness,
        mass=structure.mass,
        dofs=structure.dofs,
        positions=dict(zip(structure.mesh.names, structure.mesh.positions, strict=True)),
        fixed=[("A", dof) for dof in DOFS if dof != "drz"],
    )
    shape = structure.rigid_field(rotation=(0.0, 0.0, 1.0))[hinged.free]
    found = hinged.rigid_shapes()
    np.testing.assert_array_equal(found[:, 0] / found[np.abs(shape).argmax(), 0], shape)


def test_a_mechanism_inside_is_found() -> None:
    """Three masses on a line, of which the two springs join only two: the third is loose."""
    stiffness = np.zeros((3, 3))
    stiffness[:2, :2] = [[3.0, -1.0], [-1.0, 1.0]]
    dofs: list[Dof] = [("P", "dx"), ("Q", "dx"), ("R", "dx")]
    model = Matrices(stiffness=stiffness, mass=np.eye(3), dofs=dofs)
    np.testing.assert_array_equal(model.rigid_shapes(), [[0.0], [0.0], [1.0]])


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 8), st.integers(0, 3), st.integers(0, 2**32 - 1))
def test_the_null_space_of_any_matrix_is_found(rank: int, missing: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    size = rank + missing
    factor = random.standard_normal((size, size))
    orthogonal = np.linalg.qr(factor)[0][:, :rank]
    stiffness = (orthogonal * random.uniform(1.0, 100.0, rank)) @ orthogonal.T
    dofs = [(f"N{number}", "dx") for number in range(size)]
    model = Matrices(stiffness=stiffness, mass=np.eye(size), dofs=dofs, accuracy=1e-12)
    shapes = model.rigid_shapes()
    assert shapes.shape == (size, missing)
    np.testing.assert_allclose(stiffness @ shapes, 0.0, atol=1e-10)


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 12), st.floats(0.05, 0.9), st.integers(0, 2**32 - 1))
def test_random_sparse_matrices_arrive_unchanged(size: int, density: float, seed: int) -> None:
    random = np.random.default_rng(seed)
    given_half = sp.random_array((size, size), density=density, rng=random, format="coo")
    symmetric = (given_half + given_half.T).tocsr()
    skew = (given_half - given_half.T).tocsr()
    model = Matrices(
        stiffness=symmetric,
        mass=sp.eye_array(size),
        damping=symmetric,
        gyroscopic=skew,
        circulatory=2.0 * skew,
        dofs=[(f"N{number}", "dz") for number in range(size)],
    )
    np.testing.assert_array_equal(model.stiffness.to_dense(), symmetric.toarray())
    np.testing.assert_array_equal(model.damping.to_dense(), symmetric.toarray())
    np.testing.assert_array_equal(model.gyroscopic.to_dense(), skew.toarray())
    np.testing.assert_array_equal(model.circulatory.to_dense(), 2.0 * skew.toarray())


def test_the_null_space_of_a_large_matrix_is_found_as_that_of_a_small_one(
    cantilever: Cantilever, monkeypatch: pytest.MonkeyPatch
) -> None:
    model = of(cantilever(tip=(0.4, 0.3, 1.2), elements=40), fixed=False, positions=False)
    dense = model.rigid_shapes()
    monkeypatch.setattr("bumpstop.structure.null_motions.LARGEST_DENSE", 10)
    sparse = model.rigid_shapes()
    assert sparse.shape == dense.shape == (246, 6)
    assert np.linalg.matrix_rank(np.hstack([dense, sparse]), tol=1e-6) == 6
    clamped = of(cantilever(tip=(0.4, 0.3, 1.2), elements=40), positions=False)
    assert clamped.rigid_shapes().shape[1] == 0


def test_more_null_vectors_than_a_block_has(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("bumpstop.structure.null_motions.LARGEST_DENSE", 10)
    factor = np.random.default_rng(4).standard_normal((30, 9))
    dofs = [(f"N{number}", "dz") for number in range(30)]
    model = Matrices(stiffness=factor @ factor.T, mass=np.eye(30), dofs=dofs, accuracy=1e-12)
    shapes = model.rigid_shapes()
    assert shapes.shape == (30, 21)
    np.testing.assert_allclose(factor.T @ shapes, 0.0, atol=1e-9)


def test_weight_acts_on_nodes_of_unknown_position_too() -> None:
    model = pair(positions={"P": (0.0, 0.0, 0.0)})
    np.testing.assert_array_equal(model.rigid_field(translation=(2.0, 0.0, 0.0)), [2.0, 2.0])
    with pytest.raises(InputError, match=r"position of this node is not known .got 'Q'."):
        model.rigid_field(rotation=(0.0, 0.0, 1.0))
