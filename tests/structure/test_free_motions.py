"""Motions that strain nothing: all of them, exactly, and by their names."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from bumpstop import (
    Beam,
    Material,
    Matrices,
    PointMass,
    Rectangle,
    Relation,
    RigidLink,
    Spring,
    Structure,
    Support,
)
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.free_motions import free_motions

Array = NDArray[np.float64]

STEEL = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
BAR = Rectangle(height=0.06, width=0.025)
PLANE = Support(nodes="all", fixed=("dz", "drx", "dry"))


def beam(nodes: str, **changes: Any) -> Beam:
    given: dict[str, Any] = {"nodes": tuple(nodes), "elements": 2, "material": STEEL}
    return Beam(nodes, **given | {"section": BAR} | changes)


def hinge(first: str, second: str) -> RigidLink:
    return RigidLink(first + second, nodes=(first, second), dofs=("dx", "dy"))


def chain(supports: list[Support]) -> Structure:
    """Two bars in a plane, hinged to each other at (1, 0, 0)."""
    return Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0), "C": (1, 0, 0), "D": (1.6, 0.8, 0)},
        beams=[beam("AB"), beam("CD")],
        supports=[PLANE, *supports],
        links=[hinge("B", "C")],
    )


def truss(*bars: str) -> Structure:
    """A square of pinned bars, on a pin and a roller."""
    return Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0), "C": (1, 1, 0), "D": (0, 1, 0)},
        beams=[beam(bar, theory="bar", elements=1) for bar in ("AB", "BC", "CD", "DA", *bars)],
        supports=[
            Support(nodes="all", fixed="dz"),
            Support(nodes="A", fixed=("dx", "dy")),
            Support(nodes="B", fixed="dy"),
        ],
    )


def check(structure: Structure) -> None:
    """Compare with the null space of the scaled reduced stiffness, by eigenvalues."""
    stiffness = structure.reduced(structure.stiffness).to_dense()
    diagonal = stiffness.diagonal()
    scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    scaled = stiffness * np.outer(scale, scale)
    number = np.count_nonzero(np.linalg.eigvalsh(scaled) < 1e-10)
    shapes = structure.rigid_shapes()
    assert shapes.shape == (len(structure.free), number)
    if number:
        sizes = np.linalg.norm(shapes / scale[:, np.newaxis], axis=0)
        assert np.linalg.matrix_rank(shapes / scale[:, np.newaxis] / sizes) == number
        np.testing.assert_allclose(
            stiffness @ shapes * scale[:, np.newaxis] / sizes, 0.0, atol=1e-13
        )


A, B, D = (Support(nodes=node, fixed=("dx", "dy")) for node in "ABD")

CASES: list[tuple[str, Structure, list[str], list[str]]] = [
    ("clamped and pinned", chain([Support(nodes="A", fixed=DOFS), D]), [], []),
    (
        "clamped",
        chain([Support(nodes="A", fixed=DOFS)]),
        [],
        ["rotation about z through B of C, D and 1 more"],
    ),
    (
        "pinned",
        chain([A]),
        ["rotation about z through A"],
        ["rotation about z through B of C, D and 1 more"],
    ),
    (
        "free",
        chain([]),
        ["translation along x", "translation along y", "rotation about z"],
        ["rotation about z through B of A, B and 1 more"],
    ),
    (
        "on rollers",
        chain([Support(nodes="A", fixed="dy"), Support(nodes="D", fixed="dy")]),
        ["translation along x"],
        ["motion of C.drz, D.drz, CD.1.drz and 9 more"],
    ),
    ("unbraced truss", truss(), [], ["translation along x of C, D"]),
    ("braced truss", truss("AC"), [], []),
    (
        "two pieces",
        Structure(
            nodes={"A": (0, 0, 0), "B": (1, 0, 0), "P": (2, 0, 0)},
            beams=[beam("AB")],
            masses=[PointMass("ball", node="P", mass=1.0)],
            supports=[PLANE, A, Support(nodes="P", fixed="dx")],
        ),
        ["rotation about z through A of A, B and 1 more", "translation along y of P"],
        [],
    ),
    (
        "hinge on a slanting line",
        Structure(
            nodes={"A": (0, 0, 0), "B": (3, 4, 0), "C": (0, 0, 2)},
            beams=[beam("AB"), beam("BC")],
            supports=[Support(nodes=("A", "B"), fixed=("dx", "dy", "dz"))],
        ),
        ["rotation about (0.6, 0.8, 0) through A"],
        [],
    ),
    (
        "screw",
        Structure(
            nodes={"A": (0, 1, 0), "B": (1, 1, 0)},
            beams=[beam("AB")],
            supports=[Support(nodes="A", fixed=("dy", "dz", "dry", "drz"))],
            relations=[Relation({("A", "dx"): 1.0, ("A", "drx"): -0.01})],
        ),
        ["screw along x through A, 0.01 m a radian"],
        [],
    ),
    (
        "axis where no node is",
        Structure(
            nodes={"A": (1, 0, 0), "B": (2, 0, 0)},
            beams=[beam("AB")],
            supports=[PLANE, Support(nodes="A", fixed="dx")],
            relations=[Relation({("A", "dy"): 1.0, ("A", "drz"): -1.5})],
        ),
        ["rotation about z through (-0.5, 0, 0)"],
        [],
    ),
    (
        "a spring to the ground",
        Structure(
            nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
            beams=[beam("AB")],
            springs=[Spring("mount", node="A", stiffness=(1e3, 1e3, 0, 0, 0, 0))],
            supports=[PLANE],
        ),
        ["rotation about z through A"],
        [],
    ),
    (
        "loose masses",
        Structure(
            nodes={"P": (0, 0, 0), "Q": (1, 0, 0), "R": (2, 0, 0)},
            masses=[PointMass(node, node=node, mass=1.0) for node in "PQR"],
            springs=[
                Spring("first", node="P", other="Q", stiffness=1e3),
                Spring("second", node="Q", other="R", stiffness=1e3),
            ],
            supports=[Support(nodes="all", fixed="dz")],
        ),
        ["translation along x", "translation along y", "rotation about z"],
        ["translation along y of P"],
    ),
]


@pytest.mark.parametrize(
    ("structure", "whole", "mechanisms"), [c[1:] for c in CASES], ids=[c[0] for c in CASES]
)
def test_free_motions_are_found_and_named(
    structure: Structure, whole: list[str], mechanisms: list[str]
) -> None:
    check(structure)
    motions = free_motions(structure)
    assert [motion.text for motion in motions if not motion.is_mechanism] == whole
    assert [motion.text for motion in motions if motion.is_mechanism] == mechanisms


def test_a_spring_is_seen_however_soft() -> None:
    """1e-6 N/m beside 3e8 N/m: below the rounding of the assembled matrix."""
    structure = Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
        beams=[beam("AB", elements=1)],
        springs=[Spring("soft", node="B", stiffness=(0, 1e-6, 0, 0, 0, 0))],
        supports=[PLANE, A],
    )
    assert free_motions(structure) == []


def test_positions_unknown() -> None:
    pair = Matrices(
        stiffness=[[1e4, -1e4], [-1e4, 1e4]],
        mass=[[2.0, 0.0], [0.0, 3.0]],
        dofs=[("P", "dx"), ("Q", "dx")],
    )
    (motion,) = free_motions(pair)
    assert (motion.text, motion.is_mechanism) == ("translation along x", False)


def test_what_may_be_a_rotation_is_not_known_without_positions() -> None:
    """A bar that floats: two dofs across it, and no stiffness against its rotation."""
    bar = np.array([[1.0, -2.0, 1.0], [-2.0, 4.0, -2.0], [1.0, -2.0, 1.0]])
    dofs = [("P", "dy"), ("Q", "dy"), ("R", "dy")]
    floating = Matrices(stiffness=1e4 * bar, mass=np.eye(3), dofs=dofs)
    assert [motion.is_mechanism for motion in free_motions(floating)] == [False, True]
    places = {"P": (0, 0, 0), "Q": (1, 0, 0), "R": (2, 0, 0)}
    placed = Matrices(stiffness=1e4 * bar, mass=np.eye(3), dofs=dofs, positions=places)
    texts = [motion.text for motion in free_motions(placed)]
    assert texts == ["translation along y", "rotation about z through P"]


def test_a_piece_is_named_where_others_can_move_too() -> None:
    """A clamped beam and a loose one; the wall that carries a node of its own is no piece."""
    structure = Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0), "C": (1, 0, 0), "D": (2, 0, 0), "wall": (0, 1, 0)},
        beams=[beam("AB"), beam("CD")],
        supports=[Support(nodes=("A", "wall"), fixed=DOFS)],
    )
    motions = free_motions(structure)
    assert len(motions) == 6
    assert {motion.piece for motion in motions} == {"C, D and 1 more"}
    alone = Structure(
        nodes={"C": (1, 0, 0), "D": (2, 0, 0), "wall": (0, 1, 0)},
        beams=[beam("CD")],
        supports=[Support(nodes="wall", fixed=DOFS)],
    )
    assert {motion.piece for motion in free_motions(alone)} == {""}


def test_a_damper_joins_two_pieces() -> None:
    pair = Structure(
        nodes={"P": (0, 0, 0), "Q": (1, 0, 0)},
        masses=[PointMass(node, node=node, mass=1.0) for node in "PQ"],
        springs=[Spring("damper", node="P", other="Q", damping=1.0)],
        supports=[Support(nodes="all", fixed=("dy", "dz", "drx", "dry", "drz"))],
    )
    assert [motion.piece for motion in free_motions(pair)] == ["", ""]


def test_a_chain_of_many_links() -> None:
    """Ten hinged bars hanging from a pin: ten free rotations, all exact."""
    size = 10
    nodes: dict[str, tuple[float, float, float]] = {}
    for i in range(size):
        nodes |= {f"a{i}": (0.3 * i, -0.4 * i, 0), f"b{i}": (0.3 * i + 0.3, -0.4 * i - 0.4, 0)}
    structure = Structure(
        nodes=nodes,
        beams=[
            Beam(f"r{i}", nodes=(f"a{i}", f"b{i}"), elements=3, material=STEEL, section=BAR)
            for i in range(size)
        ],
        supports=[PLANE, Support(nodes="a0", fixed=("dx", "dy"))],
        links=[hinge(f"b{i}", f"a{i + 1}") for i in range(size - 1)],
    )
    check(structure)
    motions = free_motions(structure)
    assert [motion.is_mechanism for motion in motions] == [False] + [True] * (size - 1)
    assert motions[0].text == "rotation about z through a0"
