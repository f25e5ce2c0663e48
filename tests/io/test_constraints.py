"""Relations and rigid links in case files."""

from collections.abc import Callable

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.structure.dofs import DOFS

Load = Callable[[str], bs.Case]
Refused = Callable[[str], str]

SEESAW = """
[nodes]
A = [-1, 0, 0]
B = [2, 0, 0]
[masses.a]
node = "A"
mass = 2.0
[masses.b]
node = "B"
mass = 3.0
[[supports]]
nodes = "all"
fixed = ["dx", "dz", "drx", "dry", "drz"]
[[relations]]               # a lever about the origin
terms = { A.dy = 2.0, B.dy = 1.0 }
[basis]
modes = 1
[run]
duration = 1.0
"""

LEVER = "terms = { A.dy = 2.0, B.dy = 1.0 }"

ARM = """
[nodes]
A = [0, 0, 0]
B = [1, 0, 0]
P = [1, "30 cm", 0]
[materials.steel]
young_modulus = "210 GPa"
poisson_ratio = 0.3
density = 7800.0
[sections.bar]
shape = "rectangle"
height = "6 cm"
width = "2.5 cm"
[beams.AB]
nodes = ["A", "B"]
elements = 3
material = "steel"
section = "bar"
[masses.lump]
node = "P"
mass = 4.0
[links.arm]
nodes = ["B", "P"]
[[supports]]
nodes = ["A"]
fixed = ["dx", "dy", "dz", "drx", "dry", "drz"]
[basis]
modes = 3
[run]
duration = 1.0
"""


def test_a_lever(load: Load) -> None:
    basis = load(SEESAW).problems["base"].basis
    a, b = basis.row("A", "dy")[0], basis.row("B", "dy")[0]
    assert b == -2.0 * a
    assert 2.0 * a**2 + 3.0 * b**2 == pytest.approx(1.0)


def test_a_weight_may_be_a_length(load: Load) -> None:
    """A beam that rolls on a rim of 200 mm as it moves along."""
    held = ", ".join(f'"{dof}"' for dof in DOFS)
    rim = '[[relations]]\nterms = { A.dx = 1, A.drz = "200 mm" }\n[[supports]]'
    text = ARM.replace(held, '"dy", "dz", "drx", "dry"').replace("[[supports]]", rim)
    basis = load(text).problems["base"].basis
    assert basis.omega2[0] == 0.0
    np.testing.assert_allclose(basis.row("A", "dx"), -0.2 * basis.row("A", "drz"), rtol=1e-15)


def test_a_link_of_the_file_is_that_of_python(load: Load) -> None:
    basis = load(ARM).problems["base"].basis
    steel = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
    bar = bs.Rectangle(height=0.06, width=0.025)
    structure = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0), "P": (1, 0.3, 0)},
        beams=[bs.Beam("AB", nodes=("A", "B"), elements=3, material=steel, section=bar)],
        masses=[bs.PointMass("lump", node="P", mass=4.0)],
        supports=[bs.Support(nodes="A", fixed=DOFS)],
        links=[bs.RigidLink("arm", nodes=("B", "P"))],
    )
    np.testing.assert_array_equal(
        basis.omega2, bs.ModalBasis.from_structure(structure, modes=3).omega2
    )


def test_variants_change_a_weight(load: Load) -> None:
    case = load(SEESAW + '[variants.even]\n"relations.0.terms.A.dy" = 1.0\n[variants.base]\n')
    assert case.problems["even"].basis is not case.problems["base"].basis
    basis = case.problems["even"].basis
    assert basis.row("B", "dy")[0] == -basis.row("A", "dy")[0]


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ("terms = {}", "relations.0.terms: must have a term"),
        ("terms = { A.dy = 0.0 }", "relations.0.terms.A.dy: must not be zero"),
        ("terms = { A.y = 1.0 }", "relations.0.terms.A.y: is not one of the known words"),
        ('terms = { A.dy = "2 kg" }', "relations.0.terms.A.dy: "),
        ("terms = { A = 1.0 }", "relations.0.terms.A: "),
        ("terms = { C.dy = 1.0 }", "relations.0.terms: unknown node (got 'C')"),
        ('terms = { "AB@0.1".dy = 1.0 }', "relations.0.terms: unknown beam (got 'AB')"),
        ("weights = { A.dy = 1.0 }", "relations.0.weights: unknown key"),
    ],
)
def test_bad_relations_are_refused(refused: Refused, wrong: str, message: str) -> None:
    assert message in refused(SEESAW.replace(LEVER, wrong))


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ('nodes = ["B"]', "links.arm.nodes: must name two nodes or more"),
        ('nodes = ["B", "B"]', "links.arm.nodes: this name is used twice"),
        ('nodes = ["B", "Q"]', "links.arm.nodes: unknown node (got 'Q')"),
        ('nodes = "BP"', "links.arm.nodes: must be a list of node names"),
        ('nodes = ["B", "P"]\ndofs = ["x"]', "links.arm.dofs.0: "),
        ('nodes = ["B", "P"]\ndofs = ["dx", "dx"]', "links.arm.dofs: this name is used twice"),
        ('nodes = ["B", "P"]\nmaster = "B"', "links.arm.master: unknown key"),
    ],
)
def test_bad_links_are_refused(refused: Refused, wrong: str, message: str) -> None:
    assert message in refused(ARM.replace('nodes = ["B", "P"]', wrong))


def test_rigid_modes_are_announced_in_the_basis(load: Load, refused: Refused) -> None:
    free = SEESAW.replace("modes = 1", "modes = 1\nrigid_modes = 1")
    assert load(free).problems["base"].basis.omega2[0] == 0.0
    none = SEESAW.replace("modes = 1", "modes = 1\nrigid_modes = 0")
    assert refused(none) == (
        "basis.rigid_modes: 1 motion is free of strain: rotation about z through (0, 0, 0) (got 0)"
    )
    assert "basis.rigid_modes: must be 0 or more" in refused(none.replace("s = 0", "s = -1"))


def test_a_mechanism_is_refused_at_its_key(refused: Refused) -> None:
    """A ball joint in the arm lets its mass swing."""
    ball = ARM.replace('nodes = ["B", "P"]', 'nodes = ["B", "C"]\ndofs = ["dx", "dy", "dz"]')
    ball = ball.replace("[materials", "C = [1, 0, 0]\n[materials", 1)
    ball += '[links.rod]\nnodes = ["C", "P"]\n'
    message = refused(ball)
    assert "basis.rigid_modes: a mechanism: rotation about z through B of P, C; " in message
    assert message.endswith("or say rigid_modes = 2 if it is meant to move")
