from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from bumpstop import Beam, InputError, Material, ModalBasis, Rectangle, Relation, Structure, Support
from bumpstop.structure.dofs import DOFS

Array = NDArray[np.float64]

STEEL = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
BAR = Rectangle(height=0.06, width=0.025)
CLAMPED = Support(nodes="A", fixed=DOFS)


def portal(**changes: Any) -> Structure:
    """A portal frame whose lintel is not yet joined to the columns."""
    nodes = {
        "A": (0, 0, 0),
        "B": (0, 0, 3),
        "B2": (0, 0, 3),
        "C2": (4, 0, 3),
        "C": (4, 0, 3),
        "D": (4, 0, 0),
    }
    spans = {"left": ("A", "B"), "lintel": ("B2", "C2"), "right": ("D", "C")}
    given: dict[str, Any] = {
        "nodes": nodes,
        "beams": [
            Beam(name, nodes=ends, elements=3, material=STEEL, section=BAR)
            for name, ends in spans.items()
        ],
        "supports": [Support(nodes=("A", "D"), fixed=DOFS)],
    }
    return Structure(**given | changes)


def same(*pairs: tuple[str, str], dofs: tuple[str, ...] = DOFS) -> list[Relation]:
    return [Relation({(b, dof): 1.0, (a, dof): -1.0}) for a, b in pairs for dof in dofs]


HINGES = same(("B", "B2"), ("C", "C2"), dofs=("dx", "dy", "dz", "drx", "drz"))


def solved(structure: Structure, force: Array) -> Array:
    """Return the static displacement under a force on all dofs."""
    expansion = structure.expansion
    stiffness = structure.reduced(structure.stiffness).to_dense()
    return expansion @ np.array(np.linalg.solve(stiffness, expansion.transposed() @ force))


def lagrange(structure: Structure, force: Array) -> Array:
    """Return the same by Lagrange multipliers: nothing is eliminated."""
    size = len(structure.dofs)
    rows = []
    for support in structure.supports:
        rows += [np.eye(size)[dof] for dof in support.held(structure.mesh, "")]
    for relation in structure.relations:
        row = np.zeros(size)
        for (node, dof), weight in relation.terms.items():
            form = structure.displacement_form(node, dof)
            row[form.dofs] += weight * form.weights
        rows.append(row)
    ties = np.array(rows)
    stiffness = structure.stiffness.to_dense()
    scale = np.abs(stiffness).max()
    whole = np.block([[stiffness, scale * ties.T], [scale * ties, np.zeros((len(ties),) * 2)]])
    right = np.concatenate([force, np.zeros(len(ties))])
    solution = np.array(np.linalg.lstsq(whole, right, rcond=1e-14)[0])
    return solution[:size]


def push(structure: Structure, node: str, dof: str) -> Array:
    force = np.zeros(len(structure.dofs))
    force[structure.dofs.index((node, dof))] = 1000.0
    return force


def test_a_frame_joined_by_relations_is_the_frame() -> None:
    joined = portal(relations=same(("B", "B2"), ("C", "C2")))
    nodes = {node: place for node, place in joined.nodes.items() if len(node) == 1}
    whole = portal(
        nodes=nodes,
        beams=[
            Beam(name, nodes=ends, elements=3, material=STEEL, section=BAR)
            for name, ends in {
                "left": ("A", "B"),
                "lintel": ("B", "C"),
                "right": ("D", "C"),
            }.items()
        ],
    )
    basis, expected = (ModalBasis.from_structure(s, modes=12) for s in (joined, whole))
    np.testing.assert_allclose(basis.omega2, expected.omega2, rtol=1e-10)
    np.testing.assert_array_equal(basis.row("B", "dx"), basis.row("B2", "dx"))


def test_a_portal_with_hinges_sways_as_two_cantilevers() -> None:
    """The hinged lintel carries no moment: each column takes half of a push, H h3 / 3 E I."""
    structure = portal(relations=HINGES)
    half = 0.5 * (push(structure, "B", "dx") + push(structure, "C", "dx"))
    sway = solved(structure, half)[structure.dofs.index(("B", "dx"))]
    bending = 500.0 * 27.0 / (3.0 * STEEL.young_modulus * BAR.inertia_y)
    shear = 500.0 * 3.0 / (STEEL.shear_modulus * BAR.area * BAR.shear_factors[1])
    assert sway == pytest.approx(bending + shear, rel=1e-11)


@pytest.mark.parametrize(
    "relations",
    [
        HINGES,
        same(("B", "B2"), ("C", "C2")),
        [*HINGES, Relation({("lintel@1.3", "dz"): 2.0, ("left@1.0 m", "dx"): 1.0})],
        [*HINGES, Relation({("B", "dry"): 3.0, ("C", "dx"): 1.0, ("C", "dry"): -0.1})],
        [*HINGES, *HINGES],
    ],
    ids=["hinges", "rigid", "along beams", "rotations", "twice"],
)
@pytest.mark.parametrize("target", [("B", "dx"), ("C2", "dz"), ("lintel.1", "dy")])
def test_against_lagrange_multipliers(relations: list[Relation], target: tuple[str, str]) -> None:
    structure = portal(relations=relations)
    force = push(structure, *target)
    expected = lagrange(structure, force)
    error = np.abs(solved(structure, force) - expected).max()
    assert error < 1e-7 * np.abs(expected).max()


def test_reduced_matrices_keep_energy_and_symmetry() -> None:
    structure = portal(relations=HINGES)
    x = np.random.default_rng(4).normal(size=len(structure.free))
    u = structure.expansion @ x
    np.testing.assert_array_equal(u[structure.free], x)
    for matrix in (structure.stiffness, structure.mass):
        reduced = structure.reduced(matrix)
        assert x @ (reduced @ x) == pytest.approx(u @ (matrix @ u), rel=1e-12)
        np.testing.assert_array_equal(reduced.to_dense(), reduced.to_dense().T)


def test_a_rolling_wheel_has_the_inertia_of_both_motions() -> None:
    """A bar that rolls: half of m v2 and J w2 go together."""
    bar = Structure(
        nodes={"A": (0, 0, 0), "B": (0, 0, 1)},
        beams=[Beam("axle", nodes=("A", "B"), elements=1, material=STEEL, section=BAR)],
        supports=[
            Support(nodes="all", fixed=("dy", "dz", "drx", "dry")),
        ],
        relations=[
            Relation({("A", "dx"): 1.0, ("A", "drz"): 0.2}),
            *same(("A", "B"), dofs=("dx", "drz")),
        ],
    )
    basis = ModalBasis.from_structure(bar, modes=1)
    mass = STEEL.density * BAR.area
    inertia = STEEL.density * (BAR.inertia_y + BAR.inertia_z)
    assert basis.omega2[0] == 0.0
    assert basis.row("A", "dx")[0] ** -2 == pytest.approx(mass + inertia / 0.04, rel=1e-12)
    assert basis.row("A", "dx")[0] == pytest.approx(-0.2 * basis.row("B", "drz")[0], rel=1e-14)


@pytest.mark.parametrize(
    ("terms", "message"),
    [
        ({}, "terms: must have a term"),
        ([("A", "dx", 1.0)], "terms: must map"),
        ({"A.dx": 1.0}, "terms: must be a node and a dof"),
        ({("A", "x"): 1.0}, "dof: unknown dof"),
        ({("A", "dx"): 0.0}, "terms.A.dx: must not be zero"),
        ({("A", "dx"): float("nan")}, "terms.A.dx: must be finite"),
    ],
)
def test_bad_relations_are_refused(terms: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Relation(terms)


@pytest.mark.parametrize(
    ("terms", "message"),
    [
        ({("E", "dx"): 1.0}, r"relations\[1\].terms: unknown node \(got 'E'\)"),
        ({("left@9", "dx"): 1.0}, r"relations\[1\].terms: must be on the beam"),
    ],
)
def test_relations_of_what_is_not_there_are_refused(terms: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        portal(relations=[HINGES[0], Relation(terms)])
