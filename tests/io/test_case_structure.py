"""Beams, sections, masses, springs and bearings of case files, as those made in Python."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import bumpstop as bs

Load = Callable[[str], bs.Case]

ROTOR = """
[nodes]
A = [0, 0, 0]
B = ["40 cm", 0, 0]
C = [0.8, 0, 0]
[materials.steel]
young_modulus = "210 GPa"
poisson_ratio = 0.3
density = 7850
[sections.thick]
shape = "circle"
radius = "2 cm"
[sections.thin]
shape = "circle"
radius = "1.5 cm"
shear_factors = "cowper"
[beams.AB]
nodes = ["A", "B"]
elements = 2
theory = "rayleigh"
material = "steel"
section = "thick"
added_mass = "0.1 kg/m"
spin = "3000 rpm"
[beams.BC]
nodes = ["B", "C"]
elements = 2
material = "steel"
section = "thin"
end_section = "thick"
roll = "30 deg"
mass = "lumped"
tension = "-1 kN"
[masses.disc]
node = "B"
mass = "8 kg"
inertia = ["0.04 kg m^2", 0.02, 0.02]
offset = [0, 0, "1 mm"]
axes = [[1, 0, 0], [0, 1, 0]]
spin = "3000 rpm"
[springs.mount]
node = "C"
stiffness = [0, "1 MN/m", 1e6, 0, "5 N m", 0]
damping = [0, "20 N*s/m", 20, 0, "1 N*m*s", 0]
[springs.strut]
node = "A"
other = "C"
stiffness = "1 kN/m"
[bearings.film]
node = "A"
axis = [1, 0, 0]
stiffness = [["20 kN/mm", "5 kN/mm"], [-5e6, 1e7]]
damping = "10 kN*s/m"
[[supports]]
nodes = ["A"]
fixed = ["dx", "drx"]
[basis]
modes = 6
[run]
duration = 1.0
"""


def rotor() -> bs.Structure:
    steel = bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7850.0)
    spin = 3000 / 60 * 2 * np.pi
    return bs.Structure(
        nodes={"A": (0, 0, 0), "B": (0.4, 0, 0), "C": (0.8, 0, 0)},
        beams=[
            bs.Beam(
                "AB",
                nodes=("A", "B"),
                elements=2,
                theory="rayleigh",
                material=steel,
                section=bs.Circle(radius=0.02),
                added_mass=0.1,
                spin=spin,
            ),
            bs.Beam(
                "BC",
                nodes=("B", "C"),
                elements=2,
                material=steel,
                section=bs.Circle(radius=0.015).cowper(0.3),
                end_section=bs.Circle(radius=0.02),
                roll=np.pi / 6,
                mass="lumped",
                tension=-1000.0,
            ),
        ],
        masses=[
            bs.PointMass(
                "disc",
                node="B",
                mass=8.0,
                inertia=(0.04, 0.02, 0.02),
                offset=(0, 0, 1e-3),
                spin=spin,
            )
        ],
        springs=[
            bs.Spring(
                "mount",
                node="C",
                stiffness=(0, 1e6, 1e6, 0, 5.0, 0),
                damping=(0, 20.0, 20.0, 0, 1.0, 0),
            ),
            bs.Spring("strut", node="A", other="C", stiffness=1000.0),
        ],
        bearings=[
            bs.Bearing("film", node="A", stiffness=[[2e7, 5e6], [-5e6, 1e7]], damping=1e4),
        ],
        supports=[bs.Support(nodes="A", fixed=("dx", "drx"))],
    )


def test_a_rotor_from_a_file_is_the_one_made_in_python(load: Load) -> None:
    written = load(ROTOR).problems["base"].basis.model
    assert isinstance(written, bs.Structure)
    made = rotor()
    for kind in ("stiffness", "mass", "damping", "gyroscopic", "circulatory"):
        expected = getattr(made, kind).to_dense()
        assert np.abs(expected).max() > 0.0
        tolerance = 1e-15 * np.abs(expected).max()
        np.testing.assert_allclose(getattr(written, kind).to_dense(), expected, atol=tolerance)


SECTION = '[sections.more]\nshape = "{}"\n'
TUBE, GENERAL = SECTION.format("tube"), SECTION.format("general")
BOX = SECTION.format("rectangle") + "height = 0.1\nwidth = 0.1\n"
GENERAL += 'area = "4.5 cm^2"\ninertia_y = 1e-8\ninertia_z = "1 cm^4"\n'
MASS = '[masses.more]\nnode = "C"\n'
SPRING = '[springs.more]\nnode = "C"\n'
BEARING = '[bearings.more]\nnode = "C"\n'

BAD = [
    (SECTION.format("star"), "sections.more.shape: is not a known kind (got 'star'); known:"),
    ('[sections.more]\nshpe = "tube"\n', "sections.more.shpe: unknown key (got 'tube'); did you"),
    (
        "[sections.more]\nradius = 1.0\n",
        "sections.more.shape: is missing; known: rectangle, circle, tube, general",
    ),
    (TUBE + "outer_radius = 0.1\n", "sections.more.thickness: is missing"),
    (TUBE + "outer_radius = 0.1\nthickness = 0.1\n", "sections.more.thickness: the wall fills"),
    (TUBE + "outer_radius = -0.1\nthickness = 0.1\n", "outer_radius: must be positive (got -0.1)"),
    (BOX + "thickness = 0.05\n", "sections.more.thickness: the walls fill the section"),
    (BOX + 'shear_factors = "cooper"\n', "sections.more.shear_factors: must be two numbers or"),
    (BOX + "shear_factors = [1, 0]\n", "sections.more.shear_factors.1: must be positive (got 0)"),
    (GENERAL, "sections.more.torsion_constant: is missing"),
    (GENERAL + "torsion_constant = 1\nshear_factors = [1]\n", "must be a list of 2 numbers"),
    (GENERAL + "torsion_constant = 1\nextent_y = [1, 2]\n", "more.extent_y: must be a negative"),
    (MASS + "mass = 0\n", "masses.more.mass: must be positive (got 0.0)"),
    (MASS + "mass = 1\ninertia = [1, 2]\n", "masses.more.inertia: must be three or six moments"),
    (MASS + "mass = 1\ninertia = [1, 2, '3 kg']\n", "masses.more.inertia.2: wrong unit"),
    (MASS + "mass = 1\ninertia = [1, 2, -3]\n", "masses.more.inertia: no moment of inertia may"),
    (MASS + "mass = 1\nspin = 3\n", "masses.more.inertia: what spins needs inertia"),
    (MASS + "mass = 1\naxes = [[1, 0, 0]]\n", "masses.more.axes: must be a list of 2 vectors"),
    (MASS + "mass = 1\naxes = [[1, 0, 0], [1, 0]]\n", "masses.more.axes.1: must be a list of 3"),
    (SPRING, "springs.more.stiffness: a spring needs stiffness or damping"),
    (SPRING + "stiffness = 3\n", "springs.more.stiffness: one number needs a direction (got 3.0)"),
    (SPRING + "stiffness = [1, 2]\n", "springs.more.stiffness: must be a number, six numbers or"),
    (SPRING + 'stiffness = [1, 2, 3, 4, 5, "6 N/m"]\n', "springs.more.stiffness.5: wrong unit"),
    (SPRING + "stiffness = [[1, 2], [3, 4]]\n", "springs.more.stiffness: must be a number, six"),
    (SPRING + 'stiffness = "3 kN"\nother = "A"\n', "springs.more.stiffness: wrong unit"),
    (SPRING + 'stiffness = 3\nother = "X"\n', "springs.more.other: unknown node (got 'X')"),
    (SPRING + 'stiffness = 3\nother = "C"\n', "springs.more.other: must be another node"),
    (BEARING, "bearings.more.stiffness: is missing"),
    (BEARING + "stiffness = [[1, 2, 3]]\n", "bearings.more.stiffness: must be a number or a"),
    (BEARING + "stiffness = 1\naxis = [0, 0, 0]\n", "bearings.more.axis: must not be zero"),
]


@pytest.mark.parametrize(("addition", "message"), BAD)
def test_bad_parts_are_named(load: Load, addition: str, message: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        load(ROTOR + addition)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


CHANGES = [
    ('theory = "rayleigh"', 'theory = "euler"', "beams.AB.theory: is not one of the known words"),
    ('theory = "rayleigh"', 'theory = "euler_bernoulli"', "beams.AB.theory: a beam that spins"),
    ('spin = "3000 rpm"', 'spin = "3000 m"', "beams.AB.spin: wrong unit"),
    ('roll = "30 deg"', 'roll = "30 N"', "beams.BC.roll: wrong unit"),
    ('mass = "lumped"', 'mass = "lump"', "beams.BC.mass: is not one of the known words"),
    ('added_mass = "0.1 kg/m"', "added_mass = -1", "beams.AB.added_mass: must not be negative"),
    ('end_section = "thick"', 'end_section = "thik"', "beams.BC.end_section: unknown end_section"),
    ("inertia = [", 'inertia = "round"\nx = [', "masses.disc"),
]


@pytest.mark.parametrize(("right", "wrong", "message"), CHANGES)
def test_bad_keys_of_parts_are_named(load: Load, right: str, wrong: str, message: str) -> None:
    with pytest.raises(bs.InputError) as caught:
        load(ROTOR.replace(right, wrong, 1))
    assert message in str(caught.value)


def test_a_matrix_with_units_in_a_file(load: Load) -> None:
    rows = [[0.0] * 6 for _ in range(6)]
    rows[1][1], rows[1][5], rows[5][1], rows[5][5] = 4e3, 7.0, 7.0, 9.0
    text = str(rows).replace("4000.0", '"4 kN/m"').replace("9.0", '"9 N*m"')
    case = load(ROTOR + SPRING + f"stiffness = {text.replace('7.0', chr(34) + '7 N' + chr(34))}\n")
    model = case.problems["base"].basis.model
    assert isinstance(model, bs.Structure)
    np.testing.assert_array_equal(np.array(model.springs[-1].stiffness), rows)
