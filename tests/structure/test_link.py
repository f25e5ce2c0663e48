from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from bumpstop import (
    Beam,
    InputError,
    Material,
    ModalBasis,
    PointMass,
    Rectangle,
    RigidLink,
    Structure,
    Support,
)
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.frame import rigid_motions

STEEL = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
BAR = Rectangle(height=0.06, width=0.025)
NODES = {"A": (0.0, 0.0, 0.0), "B": (1.0, 0.2, 0.1), "P": (1.3, -0.1, 0.6)}


def cantilever(**changes: Any) -> Structure:
    given: dict[str, Any] = {
        "nodes": NODES,
        "beams": [Beam("AB", nodes=("A", "B"), elements=3, material=STEEL, section=BAR)],
        "masses": [PointMass("lump", node="P", mass=5.0)],
        "supports": [Support(nodes="A", fixed=DOFS)],
        "links": [RigidLink("arm", nodes=("B", "P"))],
    }
    return Structure(**given | changes)


def test_a_mass_on_an_arm_is_a_mass_with_offset() -> None:
    """Against the closed form of a point mass at an offset: m [I, -r x; r x, -r x r x]."""
    structure = cantilever()
    plain = cantilever(nodes={"A": NODES["A"], "B": NODES["B"]}, masses=[], links=[])
    r = np.subtract(NODES["P"], NODES["B"])
    cross = np.array([[0, -r[2], r[1]], [r[2], 0, -r[0]], [-r[1], r[0], 0]])
    offset = 5.0 * np.block([[np.eye(3), -cross], [cross, -cross @ cross]])
    expected = plain.reduced(plain.mass).to_dense()
    place = [list(plain.free).index(6 + dof) for dof in range(6)]
    expected[np.ix_(place, place)] += offset
    found = structure.reduced(structure.mass).to_dense()
    np.testing.assert_allclose(found, expected, atol=1e-14 * expected.max())
    np.testing.assert_allclose(
        structure.reduced(structure.stiffness).to_dense(),
        plain.reduced(plain.stiffness).to_dense(),
        rtol=1e-14,
    )


def test_linked_nodes_move_as_one_body() -> None:
    structure = cantilever(
        nodes={**NODES, "Q": (-2.0, 0.4, 0.0)},
        links=[RigidLink("arm", nodes=("B", "P", "Q"))],
        masses=[PointMass("p", node="P", mass=5.0), PointMass("q", node="Q", mass=1.0)],
    )
    basis = ModalBasis.from_structure(structure, modes=5)
    body = [basis.row(node, dof) for node in ("B", "P", "Q") for dof in DOFS]
    places = np.array([structure.position(node) for node in ("B", "P", "Q")])
    motions = rigid_motions(places, places[0])
    np.testing.assert_allclose(body, motions @ np.array(body[:6]), atol=1e-13)


@pytest.mark.parametrize(
    "links",
    [
        [("A", "B"), ("B", "C"), ("C", "D")],
        [("D", "C"), ("C", "B"), ("B", "A")],
        [("A", "C"), ("B", "C"), ("D", "C")],
        [("A", "B"), ("B", "C"), ("C", "D"), ("D", "A")],
        [("A", "B", "C", "D"), ("C", "A")],
    ],
    ids=["chain", "chain backwards", "followed by three", "loop", "twice"],
)
def test_however_nodes_are_linked_one_body_is_left(links: list[tuple[str, ...]]) -> None:
    random = np.random.default_rng(7)
    nodes = {name: tuple(random.normal(size=3)) for name in "ABCD"}
    structure = Structure(
        nodes=nodes,
        masses=[PointMass(name, node=name, mass=1.0) for name in "ABCD"],
        links=[RigidLink(f"l{i}", nodes=pair) for i, pair in enumerate(links)],
    )
    assert len(structure.free) == 6
    motions = rigid_motions(structure.mesh.positions, np.zeros(3))
    expansion = structure.expansion.to_dense()
    weights = np.linalg.lstsq(motions, expansion, rcond=None)[0]
    np.testing.assert_allclose(motions @ weights, expansion, atol=1e-12)
    basis = ModalBasis.from_structure(structure, modes=6)
    np.testing.assert_array_equal(basis.omega2, 0.0)


def test_a_link_along_some_dofs_lets_the_others_free() -> None:
    ball = RigidLink("ball", nodes=("B", "P"), dofs=("dx", "dy", "dz"))
    rod = Beam("rod", nodes=("P", "Q"), elements=2, material=STEEL, section=BAR)
    hanging = Structure(
        nodes={**NODES, "P": NODES["B"], "Q": (2.0, 0.0, 0.0)},
        beams=[*cantilever().beams, rod],
        supports=[Support(nodes="A", fixed=DOFS)],
        links=[ball],
    )
    basis = ModalBasis.from_structure(hanging, modes=4, rigid_modes=3)
    assert list(basis.omega2 == 0.0) == [True, True, True, False]


def test_a_support_of_a_follower_holds_the_leader() -> None:
    held = Support(nodes="P", fixed=("dx", "dy", "dz"))
    structure = cantilever(supports=[held], masses=[PointMass("lump", node="B", mass=1.0)])
    np.testing.assert_array_equal(structure.expansion.to_dense()[12:15], 0.0)
    basis = ModalBasis.from_structure(structure, modes=4)
    assert list(basis.omega2 == 0.0) == [True, True, True, False]
    arm = np.subtract(NODES["B"], NODES["P"])
    turn = np.array([basis.row("B", dof) for dof in DOFS[3:]])
    shift = np.array([basis.row("B", dof) for dof in DOFS[:3]])
    np.testing.assert_allclose(np.cross(turn.T, arm), shift.T, atol=1e-13)


def test_a_point_along_a_beam_may_lead() -> None:
    structure = cantilever(links=[RigidLink("arm", nodes=("AB@0.5", "P"))])
    basis = ModalBasis.from_structure(structure, modes=3)
    offset = np.subtract(NODES["P"], structure.position("AB@0.5"))
    turn = np.array([basis.row("AB@0.5", dof) for dof in DOFS[3:]])
    shift = [basis.row("P", dof) - basis.row("AB@0.5", dof) for dof in DOFS[:3]]
    np.testing.assert_allclose(np.cross(turn.T, offset).T, shift, atol=1e-13)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"nodes": ("A",)}, "nodes: must name two nodes or more"),
        ({"nodes": "A"}, "nodes: must name two nodes or more"),
        ({"nodes": ("A", "A")}, "nodes: this name is used twice"),
        ({"nodes": ("A", "B", "B")}, "nodes: this name is used twice"),
        ({"nodes": 3}, "nodes: must be a list of names"),
        ({"dofs": ()}, "dofs: must be a list of names"),
        ({"dofs": ("dx", "dx")}, "dofs: this name is used twice"),
        ({"dofs": ("x",)}, "dofs: unknown dofs"),
        ({"name": ""}, "name: must be a name"),
    ],
)
def test_bad_links_are_refused(changes: dict[str, Any], message: str) -> None:
    given = {"name": "arm", "nodes": ("A", "B")} | changes
    with pytest.raises(InputError, match=message):
        RigidLink(given.pop("name"), **given)


def test_links_of_what_is_not_there_are_refused() -> None:
    with pytest.raises(InputError, match=r"links.arm.nodes: unknown node \(got 'Z'\)"):
        cantilever(links=[RigidLink("arm", nodes=("B", "Z"))])
    with pytest.raises(InputError, match="links: this name is used twice"):
        cantilever(links=[RigidLink("arm", nodes=("B", "P"))] * 2)
