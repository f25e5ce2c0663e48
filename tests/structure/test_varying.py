"""The element of varying section: exact solutions, and the element of constant section."""

from __future__ import annotations

import math
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from numpy.typing import NDArray

from bumpstop import (
    Beam,
    Circle,
    Gauge,
    GeneralSection,
    InputError,
    Material,
    ModalBasis,
    Rectangle,
    Section,
    Structure,
    Support,
)
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.elements import THEORIES, prismatic
from bumpstop.structure.elements.varying import VaryingElement

Array = NDArray[np.float64]
STEEL = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
LENGTH = 0.8
CHANNEL = GeneralSection(
    area=1.35e-3,
    inertia_y=2.9e-7,
    inertia_z=2.06e-6,
    torsion_constant=2.8e-8,
    shear_factors=(0.45, 0.4),
    shear_center=(0.004, -0.031),
)


def cantilever(section: Section, elements: int = 1, **said: Any) -> Structure:
    beam = Beam(
        "AB",
        nodes=("A", "B"),
        elements=elements,
        material=STEEL,
        section=section,
        **said,
    )
    return Structure(
        nodes={"A": (0, 0, 0), "B": (LENGTH, 0, 0)},
        beams=[beam],
        supports=[Support(nodes="A", fixed=DOFS)],
    )


def flexibility(structure: Structure) -> Array:
    """Displacements of the tip by unit forces there."""
    load = np.zeros((len(structure.dofs), 6))
    tip = structure.dofs.index(("B", "dx"))
    load[tip : tip + 6] = np.eye(6)
    free = structure.free
    motion = np.zeros_like(load)
    motion[free] = np.linalg.solve(structure.stiffness.restricted(free).to_dense(), load[free])
    return motion[tip : tip + 6]


@pytest.mark.parametrize("theory", ["timoshenko", "rayleigh", "euler_bernoulli"])
def test_of_constant_section_it_is_the_element_of_constant_section(theory: str) -> None:
    section = Rectangle(height=0.11, width=0.05, shear_factors=(0.85, 0.7))
    part = THEORIES[theory].slice_of(STEEL, section, 2.5)
    element = VaryingElement(LENGTH, lambda _: part)
    plain = LENGTH, part
    for varying, constant in (
        (element.stiffness(), prismatic.stiffness(*plain)),
        (element.mass(), prismatic.mass(*plain)),
        (element.lumped_mass(), prismatic.lumped_mass(*plain)),
        (element.geometric_stiffness(3e5), prismatic.geometric_stiffness(*plain, 3e5)),
        (element.gyroscopic(70.0), prismatic.gyroscopic(*plain, 70.0)),
        (element.interpolation(0.3), prismatic.interpolation(0.3, *plain)),
        (element.axial_strain(0.3, (0.1, 0.2)), prismatic.axial_strain(0.3, (0.1, 0.2), *plain)),
    ):
        np.testing.assert_allclose(varying, constant, atol=1e-14 * np.abs(constant).max())


@pytest.mark.parametrize("elements", [1, 3])
def test_a_cone_bends_stretches_and_twists_exactly(elements: int) -> None:
    """Virtual forces, integrated in 30 digits."""
    structure = cantilever(Circle(radius=0.04), elements, end_section=Circle(radius=0.025))
    young, shear = STEEL.young_modulus, STEEL.shear_modulus

    def radius(x: float) -> float:
        return 0.04 + (0.025 - 0.04) * x / LENGTH

    def integral(weight: object) -> float:
        return float(mp.quad(weight, [0, LENGTH / 2, LENGTH]))

    stretch = integral(lambda x: 1 / (young * mp.pi * radius(x) ** 2))
    slide = integral(lambda x: 7 / (6 * shear * mp.pi * radius(x) ** 2))
    bend = [
        integral(lambda x, n=n: 4 * (LENGTH - x) ** n / (young * mp.pi * radius(x) ** 4))
        for n in range(3)
    ]
    twist = integral(lambda x: 2 / (shear * mp.pi * radius(x) ** 4))
    expected = np.diag([stretch, bend[2] + slide, bend[2] + slide, twist, bend[0], bend[0]])
    expected[1, 5] = expected[5, 1] = bend[1]
    expected[2, 4] = expected[4, 2] = -bend[1]
    computed = flexibility(structure)
    np.testing.assert_allclose(computed, expected, atol=2e-12 * np.abs(expected).max())
    np.testing.assert_allclose(np.diag(computed), np.diag(expected), rtol=2e-12)


def test_a_wedge_vibrates_as_kirchhoff_found() -> None:
    """Wedge, clamped at its thick end: omega L2 sqrt(rho A / E I) = 5.315 and 15.207.

    G. Kirchhoff, 1879: zeros of a determinant of Bessel functions, here in 20 digits.
    """
    sharp = 1e-7
    structure = cantilever(
        Rectangle(height=0.02, width=0.05),
        elements=40,
        end_section=Rectangle(height=0.02 * sharp, width=0.05),
        theory="euler_bernoulli",
    )
    held = Support(nodes="all", fixed=("dx", "dz", "drx", "dry"))
    structure = Structure(
        nodes=structure.nodes, beams=structure.beams, supports=[*structure.supports, held]
    )
    with mp.workdps(20):
        # v = [a J1(s) + b I1(s)] / s with s = 2 sqrt(k x) from the tip; v = v' = 0 at the root.
        def root(s: object) -> object:
            return mp.besselj(1, s) * mp.besseli(2, s) + mp.besseli(1, s) * mp.besselj(2, s)

        zeros = [float(mp.findroot(root, start, verify=False)) for start in (4.6, 7.8)]
    thick = math.sqrt(STEEL.young_modulus * 0.02**2 / 12 / STEEL.density) / LENGTH**2
    omega = np.sqrt(ModalBasis.from_structure(structure, modes=2).omega2)
    np.testing.assert_allclose(omega, np.array(zeros) ** 2 / 4 * thick, rtol=2e-4)


def test_a_force_in_the_shear_centre_does_not_twist() -> None:
    structure = cantilever(CHANNEL)
    y, z = CHANNEL.shear_center
    sideways = flexibility(structure)
    forces = np.zeros((6, 2))
    forces[1, 0], forces[3, 0] = 1.0, -z  # along y, at the shear centre
    forces[2, 1], forces[3, 1] = 1.0, y  # along z, there
    motion = sideways @ forces
    bending = LENGTH**3 / 3 / STEEL.young_modulus
    slide = LENGTH / STEEL.shear_modulus / CHANNEL.area
    expected = bending / CHANNEL.inertia_z + slide / 0.45, bending / CHANNEL.inertia_y + slide / 0.4
    np.testing.assert_allclose(motion[[1, 2], [0, 1]], expected, rtol=1e-12)
    np.testing.assert_allclose(motion[3], 0.0, atol=1e-12 * np.abs(sideways).max())
    twist = sideways[:, 3]  # about the shear centre, which stays
    np.testing.assert_allclose(twist[1], z * twist[3], rtol=1e-10)
    np.testing.assert_allclose(twist[2], -y * twist[3], rtol=1e-10)


def test_a_channel_moves_as_a_rigid_body_without_strain() -> None:
    beam = cantilever(CHANNEL, elements=2).beams[0]
    free = Structure(nodes={"A": (0, 0, 0), "B": (LENGTH, 0.3, 0.1)}, beams=[beam])
    rigid = free.expansion @ free.rigid_shapes()
    assert rigid.shape[1] == 6
    forces = free.stiffness @ rigid
    assert np.abs(forces).max() < 1e-12 * np.abs(free.stiffness.values).max()
    total = free.rigid_field(translation=(0, 0, 1))
    weight = STEEL.density * CHANNEL.area * math.dist((0, 0, 0), (LENGTH, 0.3, 0.1))
    assert total @ (free.mass @ total) == pytest.approx(weight, rel=1e-12)


def test_bending_and_torsion_are_coupled_as_in_a_hinged_channel() -> None:
    """Both ends hinged and held in twist, one axis of symmetry: sines in closed form.

    With warping free, the mode n solves a 2 x 2 eigenproblem of the motions along y and about x
    of the shear centre; Rayleigh's rotary inertia is left out (Euler-Bernoulli).
    """
    e = -0.031
    section = GeneralSection(
        area=1.35e-3,
        inertia_y=2.9e-7,
        inertia_z=2.06e-6,
        torsion_constant=2.8e-6,
        shear_center=(0.0, e),
    )
    beam = Beam(
        "AB",
        nodes=("A", "B"),
        elements=64,
        material=STEEL,
        section=section,
        theory="euler_bernoulli",
    )
    structure = Structure(
        nodes={"A": (0, 0, 0), "B": (2.0, 0, 0)},
        beams=[beam],
        supports=[
            Support(nodes=("A", "B"), fixed=("dy", "drx")),
            Support(nodes="all", fixed=("dx", "dz", "dry")),
        ],
    )
    # Bending moves the shear centre, v_s = v - e theta; inertia belongs to the centroid.
    wave = math.pi / 2.0
    line, polar = STEEL.density * section.area, STEEL.density * (2.9e-7 + 2.06e-6)
    bending = STEEL.young_modulus * 2.06e-6 * wave**4
    torsion = STEEL.shear_modulus * 2.8e-6 * wave**2
    mass = np.array([[line, line * e], [line * e, polar + line * e**2]])
    expected = np.sort(np.linalg.eigvals(np.linalg.solve(mass, np.diag([bending, torsion]))))
    omega2 = ModalBasis.from_structure(structure, modes=6).omega2
    for value in expected:
        assert np.abs(omega2 / value - 1).min() < 3e-4


def test_gauges_and_points_follow_the_section() -> None:
    """Under a tip force the strain of a cone's upper fibre is M y / E I of that place."""
    structure = cantilever(Circle(radius=0.04), 2, end_section=Circle(radius=0.02))
    load = np.zeros(len(structure.dofs))
    load[structure.dofs.index(("B", "dy"))] = -1000.0
    field = np.zeros_like(load)
    free = structure.free
    field[free] = np.linalg.solve(structure.stiffness.restricted(free).to_dense(), load[free])
    for at in (0.1, 0.5, 0.79):
        radius = 0.04 - 0.02 * at / LENGTH
        gauge = Gauge("g", beam="AB", at=at, fibre=(radius, 0.0))
        stress = 1000.0 * (LENGTH - at) * radius / (math.pi * radius**4 / 4)
        strain = structure.strain_form(gauge).of(field)
        assert strain == pytest.approx(stress / STEEL.young_modulus, rel=1e-11)
    with pytest.raises(InputError, match="fibre: is outside the section"):
        structure.strain_form(Gauge("g", beam="AB", at=0.7, fibre=(0.03, 0.0)))
    step = 1e-5
    around = [structure.displacement_form(f"AB@{0.3 + h}", "dy").of(field) for h in (-step, step)]
    turned = structure.displacement_form("AB@0.3", "drz").of(field)
    slide = 1000.0 * 7 / 6 / (STEEL.shear_modulus * math.pi * 0.0325**2)
    assert (around[1] - around[0]) / (2 * step) == pytest.approx(turned - slide, rel=1e-7)


def test_lumped_masses_of_a_cone_are_all_of_it() -> None:
    structure = cantilever(Circle(radius=0.04), 3, end_section=Circle(radius=0.02), mass="lumped")
    mass = structure.mass
    assert len(mass.values) == np.count_nonzero(mass.diagonal()) == 24
    volume = math.pi * LENGTH / 3 * (0.04**2 + 0.04 * 0.02 + 0.02**2)
    assert mass.diagonal()[1::6].sum() == pytest.approx(STEEL.density * volume, rel=1e-13)


@pytest.mark.parametrize(
    ("said", "message"),
    [
        ({"end_section": "bar"}, "end_section: must be a section"),
        ({"end_section": Rectangle(height=1, width=1)}, "end_section: the sections at the two"),
        ({"end_section": Circle(radius=1), "theory": "bar"}, "end_section: a bar has the same"),
    ],
)
def test_bad_tapers_are_refused(said: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=f"^{message}"):
        cantilever(Circle(radius=0.04), **said)
