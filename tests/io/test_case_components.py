"""Components, parts and joints in case files."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop.structure.dofs import DOFS

Load = Callable[[str], bs.Case]

SHARED = """
[materials.steel]
young_modulus = "210 GPa"
poisson_ratio = 0.3
density = 7800.0
[sections.bar]
shape = "rectangle"
height = "60 mm"
width = "25 mm"
"""
BEAM = 'nodes = ["A", "B"]\nelements = 4\nmaterial = "steel"\nsection = "bar"\n'
COLUMN = f"""
[components.column]
interface = ["A", "B"]
modes = 4
[components.column.nodes]
A = [0, 0, 0]
B = [0, 0, "2 m"]
[components.column.beams.AB]
{BEAM}
"""
PLACES = """
[components.girder]
reduction = "free_interface"
interface = ["A", ["B", ["dx", "dy", "dz", "drx", "dry", "drz"]]]
modes = 3
nodes.A = [0, 0, 0]
nodes.B = [3, 0, 0]
beams.AB = { nodes = ["A", "B"], elements = 4, material = "steel", section = "bar" }
[parts.left]
component = "column"
[parts.right]
component = "column"
at = [3, 0, 0]
rotation = { axis = [0, 0, 1], angle = "180 deg" }
[parts.top]
component = "girder"
at = [0, 0, "2 m"]
[[joints]]
nodes = ["left.B", "top.A"]
[[joints]]
nodes = ["top.B", "right.B"]
[[supports]]
nodes = ["left.A", "right.A"]
fixed = ["dx", "dy", "dz", "drx", "dry", "drz"]
[basis]
modes = 6
[stops.wall]
node = "right.AB@1.5 m"
normal = [-1, 0, 0]
gap = "2 mm"
stiffness = 1e6
[gauges.foot]
beam = "left.AB"
at = 0.0
fibre = [0.0, "12.5 mm"]
[run]
duration = 0.2
"""
PORTAL = SHARED + COLUMN + PLACES


def component(end: tuple[float, float, float]) -> bs.Component:
    steel = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
    bar = bs.Rectangle(height=0.06, width=0.025)
    beam = bs.Beam("AB", nodes=("A", "B"), elements=4, material=steel, section=bar)
    return bs.Component(bs.Structure(nodes={"A": (0, 0, 0), "B": end}, beams=[beam]), ["A", "B"])


def test_a_case_of_parts_is_the_assembly_written_in_python(load: Load) -> None:
    column = bs.craig_bampton(component((0, 0, 2)), modes=4)
    girder = bs.free_interface(component((3, 0, 0)), modes=3)
    portal = bs.Assembly(
        parts={
            "left": bs.Placed(column),
            "right": bs.Placed(column, at=(3, 0, 0), rotation=bs.Rotation((0, 0, 1), math.pi)),
            "top": bs.Placed(girder, at=(0, 0, 2)),
        },
        joints=[("left.B", "top.A"), ("top.B", "right.B")],
        supports=[bs.Support(nodes=("left.A", "right.A"), fixed=DOFS)],
    )
    expected = bs.ModalBasis.from_structure(portal, modes=6)
    problem = load(PORTAL).problems["base"]
    np.testing.assert_array_equal(problem.basis.omega2, expected.omega2)
    np.testing.assert_array_equal(problem.basis.shapes, expected.shapes)
    assert problem.laws[0].coordinate.node == "right.AB@1.5 m"
    assert bs.simulate(problem).sample("gauge", "foot").shape == (1001,)


def test_variants_change_parts_and_components(load: Load) -> None:
    case = load(
        PORTAL
        + '[variants.guyan]\n"components.column.modes" = 0\n'
        + '[variants.hinged]\n"joints.0.dofs" = ["dx", "dy", "dz"]\n'
        + '[variants.loud]\n"stops.wall.gap" = "1 mm"\n'
        + '[variants.soft]\n"stops.wall.gap" = "3 mm"\n'
    )
    guyan, hinged, loud, soft = (case.problems[name].basis for name in case.problems)
    assert loud is soft
    assert len(guyan.dofs) == len(loud.dofs) - 8
    assert np.all(guyan.omega2 >= loud.omega2 * (1 - 1e-12))
    assert hinged.omega2[1] < loud.omega2[1]


def test_a_component_may_stand_in_a_file_of_its_own(load: Load, tmp_path: Path) -> None:
    whole = load(PORTAL).problems["base"].basis
    own = COLUMN.replace("components.column.", "")
    own = own[own.index("[nodes]") :]
    rest = '[basis]\nmodes = 1\n[run]\nduration = "1 s"\n'
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "column.toml").write_text(SHARED + own + rest)
    head = '[components.column]\ninterface = ["A", "B"]\nmodes = 4\nfile = "parts/column.toml"\n'
    apart = load(SHARED + head + PLACES).problems["base"].basis
    np.testing.assert_array_equal(apart.omega2, whole.omega2)
    finer = load(SHARED + head + "beams.AB.elements = 8\n" + PLACES).problems["base"].basis
    assert len(finer.dofs) == len(whole.dofs) + 2 * 4 * 6


def test_mistakes_in_a_components_file_are_told_there(load: Load, tmp_path: Path) -> None:
    head = '[components.column]\ninterface = ["A"]\nmodes = 4\nfile = "other.toml"\n'
    other = tmp_path / "other.toml"
    for text, message in (
        ("[nodes]\nA = [0, 0]", r"other.toml: nodes.A: must be a list of 3 numbers"),
        ("[nods]\nA = [0, 0, 0]", r"other.toml: nods: unknown key .*did you mean 'nodes'"),
        ("[basis]\nmodes = 1", r"other.toml: nodes: has no structure of its own"),
        ("[nodes", r"other.toml: end of document: is not TOML"),
    ):
        other.write_text(text)
        with pytest.raises(bs.InputError, match=message):
            load(SHARED + head + PLACES)
    other.unlink()
    with pytest.raises(bs.InputError, match=r"other.toml: no such file"):
        load(SHARED + head + PLACES)


def test_matrices_from_files_make_components(load: Load, tmp_path: Path) -> None:
    np.save(tmp_path / "k.npy", [[1e4, -1e4], [-1e4, 1e4]])
    np.save(tmp_path / "m.npy", np.diag([2.0, 1.0]))
    (tmp_path / "dofs.csv").write_text("node,dof,x,y,z\nP,dx,0,0,0\nQ,dx,1,0,0\n")
    case = load(
        '[components.half]\ninterface = ["P", "Q"]\nmodes = "all"\n'
        '[components.half.matrices]\nstiffness = "k.npy"\nmass = "m.npy"\ndofs = "dofs.csv"\n'
        '[parts.one]\ncomponent = "half"\n[parts.two]\ncomponent = "half"\nat = [2, 0, 0]\n'
        'rotation = { axis = [0, 0, 1], angle = "180 deg" }\n'
        '[[joints]]\nnodes = ["one.Q", "two.Q"]\n[basis]\nmodes = 3\n[run]\nduration = 1.0\n'
    )
    # Three masses of 2 kg in a row, free.
    expected = 1e4 / 2.0 * np.array([0.0, 1.0, 3.0])
    np.testing.assert_allclose(case.problems["base"].basis.omega2, expected, rtol=1e-13)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('component = "girder"', 'component = "grider"', r"parts.top.component: unknown component"),
        ('["left.B", "top.A"]', '["left.B", "top.C"]', r"joints.0: is not an interface node"),
        ('["left.B", "top.A"]', '["left.A", "top.A"]', r"joints.0: left.A and top.A are at diff"),
        ('["left.B", "top.A"]', '["left.B"]', r"joints.0.nodes: must be a list of 2 node names"),
        ('["top.B", "right.B"]', '["top.A", "left.B"]', r"joints.1: top.A and left.B are joined"),
        ('["left.B", "top.A"]', '["top.A", "top.A"]', r"joints.0.nodes: joins a node to itself"),
        ("axis = [0, 0, 1]", "axis = [0, 0, 0]", r"parts.right.rotation.axis: must have a length"),
        ('angle = "180 deg"', 'angle = "180 mm"', r"parts.right.rotation.angle: "),
        ("modes = 4", "modes = 400", r"components.column.modes: more modes than there are"),
        ("modes = 4", "modes = -1", r"components.column.modes: must be a whole number, 0 or more"),
        ("modes = 4", 'mode = "all"', r"components.column.mode: unknown key .*'modes'"),
        ('interface = ["A", "B"]', "", r"components.column.interface: is missing"),
        ('interface = ["A", "B"]', 'interface = ["C"]', r"components.column.interface: unknown"),
        ('interface = ["A", "B"]', 'interface = [["A"]]', r"components.column.interface.0: must"),
        ('["left.A", "right.A"]', '"all"', r"supports.0.nodes: must name interface nodes"),
        ('["left.A", "right.A"]', '["A"]', r"supports.0.nodes: is not an interface node"),
        ("density = 7800.0", 'density = "7800 m"', r"materials.steel.density: "),
        ('material = "steel"', 'material = "iron"', r"components.column.beams.AB.material: unkn"),
        ('beam = "left.AB"', 'beam = "left.BA"', r"gauges.foot.beam: unknown beam"),
        ('beam = "left.AB"', 'beam = "left AB"', r"gauges.foot.beam: must be the name of a beam"),
        ('node = "right.AB@1.5 m"', 'node = "rigth.B"', r"stops.wall.node: unknown part .*'right'"),
        ("[parts.left]", "[nodes]\nP = [0, 0, 0]\n[parts.left]", r"nodes.* exclude each other"),
        ("[parts.left]", "[masses.m]\nnode = 'A'\nmass = 1\n[parts.left]", r"masses: does not go"),
    ],
)
def test_mistakes_are_told_where_they_are(load: Load, old: str, new: Any, message: str) -> None:
    assert old in PORTAL
    with pytest.raises(bs.InputError, match=message):
        load(PORTAL.replace(old, new, 1))


def test_parts_do_not_go_with_a_structure_beside_them(load: Load) -> None:
    structure = "[nodes]\nA = [0, 0, 0]\nB = [1, 0, 0]\n[beams.AB]\n" + BEAM
    rest = "[basis]\nmodes = 1\n[run]\nduration = 1.0\n"
    with pytest.raises(bs.InputError, match=r"joints: does not go with \[nodes\]"):
        load(SHARED + structure + rest + '[[joints]]\nnodes = ["a.A", "b.B"]\n')
    with pytest.raises(bs.InputError, match=r"components: does not go with \[nodes\]"):
        load(SHARED + structure + rest + COLUMN)
    with pytest.raises(bs.InputError, match=r"nodes: is missing; name points there, place"):
        load(SHARED + rest)
    empty = '[components.c]\ninterface = ["A"]\nmodes = 1\n[parts.p]\ncomponent = "c"\n'
    with pytest.raises(bs.InputError, match=r"components.c.nodes: is missing; give nodes, matri"):
        load(empty + rest)
