from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from bumpstop import (
    Beam,
    Gauge,
    InputError,
    Material,
    PointMass,
    Rectangle,
    Structure,
    Support,
)
from bumpstop.structure.beam import MOST_ELEMENTS
from bumpstop.structure.dofs import DOFS

STEEL = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
BAR = Rectangle(height=0.06, width=0.025)
NODES = {"A": (0.0, 0.0, 0.0), "B": (1.0, 0.0, 0.0)}


def beam(name: str = "AB", **changes: Any) -> Beam:
    given = {"nodes": ("A", "B"), "elements": 2, "material": STEEL, "section": BAR}
    return Beam(name, **{**given, **changes})


def test_supports_hold_dofs() -> None:
    structure = Structure(
        nodes=NODES,
        beams=[beam()],
        supports=[
            Support(nodes="all", fixed=("dz", "drx", "dry")),
            Support(nodes=["A", "AB.1"], fixed=["dx"]),
            Support(nodes="B", fixed="dy"),
        ],
    )
    free = [structure.dofs[row] for row in structure.free]
    assert free == [
        ("A", "dy"),
        ("A", "drz"),
        ("B", "dx"),
        ("B", "drz"),
        ("AB.1", "dy"),
        ("AB.1", "drz"),
    ]


def test_assembly_adds_parts_on_shared_nodes() -> None:
    """Two beams of one element make what one beam of two elements makes."""
    nodes = {"A": (0, 0, 0), "B": (1, 0, 0), "M": (0.5, 0, 0)}
    two = Structure(
        nodes=nodes,
        beams=[
            beam("left", nodes=("A", "M"), elements=1),
            beam("right", nodes=("M", "B"), elements=1),
        ],
        masses=[PointMass("lump", node="M", mass=3.0)],
    )
    one = Structure(nodes=NODES, beams=[beam()], masses=[PointMass("lump", node="AB.1", mass=3.0)])
    np.testing.assert_array_equal(two.stiffness.to_dense(), one.stiffness.to_dense())
    np.testing.assert_array_equal(two.mass.to_dense(), one.mass.to_dense())
    lumped = one.mass.to_dense() - Structure(nodes=NODES, beams=[beam()]).mass.to_dense()
    expected = np.zeros(18)
    expected[12:15] = 3.0
    np.testing.assert_allclose(lumped, np.diag(expected), atol=1e-15)


def test_matrices_are_exactly_symmetric() -> None:
    nodes = {"A": (0, 0, 0), "B": (0.3, 0.7, -0.2), "C": (1, 1, 1)}
    structure = Structure(
        nodes=nodes,
        beams=[beam(), beam("BC", nodes=("B", "C"), elements=3), beam("CA", nodes=("C", "A"))],
    )
    for matrix in (structure.stiffness.to_dense(), structure.mass.to_dense()):
        np.testing.assert_array_equal(matrix, matrix.T)


def test_a_structure_of_one_mass() -> None:
    held = tuple(dof for dof in DOFS if dof != "dy")
    ball = Structure(
        nodes={"P": (0, 0, 0)},
        masses=[PointMass("ball", node="P", mass=2.0)],
        supports=[Support(nodes=("P",), fixed=held)],
    )
    assert [ball.dofs[row] for row in ball.free] == [("P", "dy")]
    assert ball.mass.diagonal()[1] == 2.0


def test_a_rigid_field_turns_about_its_centre() -> None:
    structure = Structure(nodes=NODES, beams=[beam()])
    field = structure.rigid_field(rotation=(0, 0, -3.8), about=(1.0, 0.0, 0.0))
    dofs = dict(zip(structure.dofs, field, strict=True))
    assert dofs["A", "dy"] == 3.8
    assert dofs["B", "dy"] == 0.0
    assert dofs["AB.1", "dy"] == pytest.approx(1.9)
    assert dofs["A", "drz"] == -3.8
    assert dofs["A", "dx"] == 0.0


def test_a_held_node_needs_no_mass() -> None:
    structure = Structure(
        nodes={**NODES, "wall": (0, 1, 0)},
        beams=[beam()],
        supports=[Support(nodes="wall", fixed=DOFS)],
    )
    assert len(structure.free) == 18


BAD: list[tuple[str, dict[str, Any], str]] = [
    ("no nodes", {"nodes": {}}, "nodes: must name at least one node"),
    ("nodes as a list", {"nodes": [(0, 0, 0)]}, "nodes: must name at least one node"),
    ("two coordinates", {"nodes": {**NODES, "C": (0, 0)}}, "nodes.C: must be a list of 3"),
    ("NaN coordinate", {"nodes": {**NODES, "B": (0, 0, math.nan)}}, "nodes.B: must be finite"),
    ("node called all", {"nodes": {**NODES, "all": (0, 0, 0)}}, "cannot be called 'all'"),
    ("node with @", {"nodes": {**NODES, "A@1": (0, 0, 0)}}, "'@' in its name"),
    ("node named like an inner one", {"nodes": {**NODES, "AB.1": (0, 0, 0)}}, "AB.1"),
    (
        "loose node",
        {"nodes": {**NODES, "C": (0, 0, 1)}},
        "nodes.C: the node is attached to nothing",
    ),
    ("ends at one node", {"beams": [beam(nodes=("A", "A"))]}, "beams.AB.nodes: the beam has no"),
    ("no length", {"nodes": {"A": (1, 2, 3), "B": (1, 2, 3)}}, "beams.AB.nodes: the beam has no"),
    ("huge coordinate", {"nodes": {**NODES, "B": (1e200, 0, 0)}}, "beams.AB: its numbers are too"),
    ("unknown node", {"beams": [beam(nodes=("A", "Bee"))]}, r"beams.AB.nodes: unknown node"),
    ("twin beams", {"beams": [beam(), beam()]}, "beams: this name is used twice"),
    ("beams not a list", {"beams": beam()}, "beams: must be a list of Beams"),
    ("something else in beams", {"beams": ["AB"]}, "beams: must hold Beams only"),
    (
        "twin masses",
        {"masses": [PointMass("m", node="A", mass=1.0), PointMass("m", node="B", mass=1.0)]},
        "masses: this name is used twice",
    ),
    (
        "mass on an unknown node",
        {"masses": [PointMass("m", node="AB.7", mass=1.0)]},
        r"masses.m.node: unknown node \(got 'AB.7'\); did you mean 'AB.1'",
    ),
    (
        "support of an unknown node",
        {"supports": [Support(nodes=("A", "B.1"), fixed=("dx",))]},
        r"supports\[0\].nodes: unknown node \(got 'B.1'\); did you mean 'AB.1'",
    ),
]


@pytest.mark.parametrize(("changes", "message"), [b[1:] for b in BAD], ids=[b[0] for b in BAD])
def test_bad_structures_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        Structure(**{"nodes": NODES, "beams": [beam()], **changes})


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("nodes", "AB"),
        ("nodes", ("A",)),
        ("nodes", ("A", "")),
        ("elements", 0),
        ("elements", -3),
        ("elements", 2.5),
        ("elements", True),
        ("elements", MOST_ELEMENTS + 1),
        ("elements", 10**30),
        ("theory", "timoschenko"),
        ("material", "steel"),
        ("section", "bar"),
    ],
)
def test_bad_beams_are_refused(key: str, value: Any) -> None:
    with pytest.raises(InputError, match=rf"^{key}: "):
        beam(**{key: value})


@pytest.mark.parametrize("mass", [0.0, -1.0, math.nan, "1 kg"])
def test_bad_masses_are_refused(mass: Any) -> None:
    with pytest.raises(InputError, match="mass: must"):
        PointMass("m", node="A", mass=mass)


@pytest.mark.parametrize(
    ("nodes", "fixed", "key"),
    [
        ((), ("dx",), "nodes"),
        (3, ("dx",), "nodes"),
        (("A", 1), ("dx",), "nodes"),
        (("A",), (), "fixed"),
        (("A",), ("rx",), "fixed"),
        (("A",), ("dx", "dX"), "fixed"),
    ],
)
def test_bad_supports_are_refused(nodes: Any, fixed: Any, key: str) -> None:
    with pytest.raises(InputError, match=rf"^{key}: "):
        Support(nodes=nodes, fixed=fixed)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("at", math.nan),
        ("at", "0.4 m"),
        ("fibre", (0.0,)),
        ("fibre", "top"),
        ("beam", ""),
        ("name", 1),
    ],
)
def test_bad_gauges_are_refused(key: str, value: Any) -> None:
    given = {"name": "g", "beam": "AB", "at": 0.4, "fibre": (0.0, 0.0), key: value}
    with pytest.raises(InputError, match=rf"^{key}: "):
        Gauge(given.pop("name"), **given)


@pytest.mark.parametrize(
    ("node", "dof", "message"),
    [
        ("C", "dy", "node: unknown node .*known: A, B, AB.1"),
        ("B", "y", "dof: unknown dof .*did you mean 'dy'"),
        ("ABC@0.3", "dy", "node: unknown beam .*did you mean 'AB'"),
        ("AB@", "dy", "node: not a length after '@'"),
        ("AB@half", "dy", "node: not a length after '@'"),
        ("AB@nan", "dy", "node: not a length after '@'"),
        ("AB@0.3 kg", "dy", r"node: unknown unit of length \(got 'AB@0.3 kg'\)"),
        ("AB@1.3", "dy", r"node: must be on the beam, which is 1 m long \(got 'AB@1.3'\)"),
        ("AB@-1 mm", "dy", "node: must be on the beam"),
    ],
)
def test_bad_targets_are_refused(node: str, dof: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Structure(nodes=NODES, beams=[beam()]).displacement_form(node, dof)
