"""Frequencies of beams under each theory against equations solved here.

The exact frequencies are zeros of a determinant: the equations of the beam in (deflection,
rotation, moment, shear force) are carried along it by a matrix exponential, and two of the four
vanish at each end.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import eigh, expm
from scipy.optimize import brentq

from bumpstop import Beam, Circle, Material, Rectangle, Section, Structure, Support
from bumpstop.structure.elements import THEORIES

Array = NDArray[np.float64]
ALLOY = Material(young_modulus=67e9, poisson_ratio=0.3, density=2400.0)
LENGTH = 0.8
DEEP = Rectangle(height=0.08, width=0.02)
ENDS: dict[str, tuple[tuple[int, ...], tuple[int, ...]]] = {
    # which of deflection, rotation, moment, shear force vanish at each end
    "pinned-pinned": ((0, 2), (0, 2)),
    "clamped-free": ((0, 1), (2, 3)),
    "free-free": ((2, 3), (2, 3)),
    "clamped-clamped": ((0, 1), (0, 1)),
}
DOFS = ("dy", "drz")


def plane_beam(
    theory: str, ends: str, elements: int, section: Section = DEEP, **said: Any
) -> Structure:
    beam = Beam(
        "AB",
        nodes=("A", "B"),
        elements=elements,
        material=ALLOY,
        section=section,
        theory=theory,
        **said,
    )
    supports = [Support(nodes="all", fixed=("dx", "dz", "drx", "dry"))]
    for node, zero in zip("AB", ENDS[ends], strict=True):
        held = [DOFS[i] for i in zero if i < 2]
        supports += [Support(nodes=node, fixed=held)] if held else []
    return Structure(nodes={"A": (0, 0, 0), "B": (LENGTH, 0, 0)}, beams=[beam], supports=supports)


def computed(structure: Structure, count: int) -> Array:
    """The lowest squared frequencies."""
    stiffness, mass = (
        structure.reduced(matrix).to_dense() for matrix in (structure.stiffness, structure.mass)
    )
    values: Array = eigh(stiffness, mass, eigvals_only=True, subset_by_index=[0, count - 1])
    return values


def exact(theory: str, ends: str, near: float, section: Section = DEEP) -> float:
    """The squared frequency of the continuous beam nearest to a good estimate."""
    said = THEORIES[theory]
    bending = ALLOY.young_modulus * section.inertia_z
    shear = ALLOY.shear_modulus * section.area * section.shear_factors[0]
    line = ALLOY.density * section.area
    inertia = ALLOY.density * section.inertia_z if said.rotary else 0.0
    left, right = ENDS[ends]
    free = [i for i in range(4) if i not in left]
    scale = np.array([LENGTH, 1.0, bending / LENGTH, bending / LENGTH**2])

    def determinant(omega2: float) -> float:
        rates = np.array(
            [
                [0, 1, 0, 1 / shear if said.shear else 0.0],
                [0, 0, 1 / bending, 0],
                [0, -inertia * omega2, 0, -1],
                [-line * omega2, 0, 0, 0],
            ]
        )
        carried = expm(rates * LENGTH * scale / scale[:, np.newaxis])
        return float(np.linalg.det(carried[np.ix_(right, free)]))

    return float(brentq(determinant, 0.97 * near, 1.03 * near, xtol=1e-15 * near, rtol=1e-14))


@pytest.mark.parametrize("ends", list(ENDS))
@pytest.mark.parametrize("theory", ["timoshenko", "rayleigh", "euler_bernoulli"])
def test_converged_frequencies(theory: str, ends: str) -> None:
    rigid = 2 if ends == "free-free" else 0
    # Timoshenko's element has one shear strain: its order is 2, and Richardson's step removes it.
    fine, finer = (48, 96) if theory == "timoshenko" else (36, 72)
    order = 2 if theory == "timoshenko" else 4
    coarse, better = (computed(plane_beam(theory, ends, n), rigid + 3) for n in (fine, finer))
    limit = better + (better - coarse) / (2**order - 1)
    for mode in range(rigid, rigid + 3):
        frequency = math.sqrt(exact(theory, ends, limit[mode]))
        assert math.sqrt(limit[mode]) == pytest.approx(frequency, rel=1e-6)
        if theory != "timoshenko":
            assert math.sqrt(better[mode]) == pytest.approx(frequency, rel=1e-6)


@pytest.mark.parametrize("ends", ["pinned-pinned", "clamped-free"])
@pytest.mark.parametrize(
    ("theory", "mass", "order"),
    [
        ("timoshenko", "consistent", 2),
        ("rayleigh", "consistent", 4),
        ("euler_bernoulli", "consistent", 4),
        ("timoshenko", "lumped", 2),
        ("euler_bernoulli", "lumped", 2),
    ],
)
def test_orders_of_convergence(theory: str, mass: str, order: int, ends: str) -> None:
    estimate = computed(plane_beam(theory, ends, 60), 2)[1]
    limit = exact(theory, ends, estimate)
    errors = np.array(
        [computed(plane_beam(theory, ends, n, mass=mass), 2)[1] / limit - 1 for n in (8, 16, 32)]
    )
    np.testing.assert_allclose(np.log2(errors[:-1] / errors[1:])[-1], order, atol=0.2)


def test_slender_beams_agree_under_all_theories() -> None:
    slender = Rectangle(height=0.0008, width=0.02)
    values = [
        computed(plane_beam(theory, "clamped-free", 16, slender), 1)[0]
        for theory in ("timoshenko", "rayleigh", "euler_bernoulli")
    ]
    np.testing.assert_allclose(values, values[0], rtol=1e-5)
    assert values[0] <= values[1] <= values[2]


def along(elements: int, free: str, **said: Any) -> Array:
    """Squared frequencies of a clamped bar that can only stretch, or only twist."""
    beam = Beam("AB", nodes=("A", "B"), elements=elements, material=ALLOY, section=DEEP, **said)
    held = [dof for dof in ("dx", "dy", "dz", "drx", "dry", "drz") if dof != free]
    structure = Structure(
        nodes={"A": (0, 0, 0), "B": (LENGTH, 0, 0)},
        beams=[beam],
        supports=[Support(nodes="all", fixed=held), Support(nodes="A", fixed=free)],
    )
    return computed(structure, 2)


@pytest.mark.parametrize("theory", ["timoshenko", "euler_bernoulli", "bar"])
@pytest.mark.parametrize(("mass", "sign"), [("consistent", 1), ("lumped", -1)])
def test_stretching(theory: str, mass: str, sign: int) -> None:
    """omega_n = (2 n - 1) pi / 2 L sqrt(E / rho), from above or below at second order."""
    wave = ALLOY.young_modulus / ALLOY.density * (np.array([1, 3]) * np.pi / 2 / LENGTH) ** 2
    errors = [along(n, "dx", theory=theory, mass=mass) / wave - 1 for n in (20, 40)]
    np.testing.assert_allclose(errors[0] / errors[1], 4.0, rtol=0.02)
    assert np.all(sign * errors[1] > 0.0)
    np.testing.assert_allclose(errors[1], sign * wave / wave[0] * (np.pi / 80) ** 2 / 12, rtol=0.01)


def test_twisting() -> None:
    """omega_n = (2 n - 1) pi / 2 L sqrt(G J / rho Ip)."""
    polar = ALLOY.density * (DEEP.inertia_y + DEEP.inertia_z)
    speed2 = ALLOY.shear_modulus * DEEP.torsion_constant / polar
    wave = speed2 * (np.array([1, 3]) * np.pi / 2 / LENGTH) ** 2
    coarse, fine = along(40, "drx"), along(80, "drx")
    np.testing.assert_allclose(fine + (fine - coarse) / 3, wave, rtol=1e-6)


@pytest.mark.parametrize("tension", [5e4, -3e4])
def test_tension_stiffens_a_pinned_beam(tension: float) -> None:
    """omega_n2 = (n pi / L)4 E I / m (1 + T L2 / (n2 pi2 E I)), Euler-Bernoulli."""
    structure = plane_beam("euler_bernoulli", "pinned-pinned", 48, tension=tension)
    bending, line = ALLOY.young_modulus * DEEP.inertia_z, ALLOY.density * DEEP.area
    wave = np.array([1, 2, 3]) * np.pi / LENGTH
    expected = wave**4 * bending / line * (1 + tension / (wave**2 * bending))
    np.testing.assert_allclose(computed(structure, 3), expected, rtol=4e-6)


@pytest.mark.parametrize(
    ("theory", "ends", "factor"),
    [
        ("euler_bernoulli", "pinned-pinned", 1.0),
        ("euler_bernoulli", "clamped-free", 0.25),
        ("euler_bernoulli", "clamped-clamped", 4.0),
        ("timoshenko", "pinned-pinned", 1.0),
    ],
)
def test_at_the_buckling_load_the_lowest_frequency_is_zero(
    theory: str, ends: str, factor: float
) -> None:
    """Euler's load, with Engesser's correction for shear: P = PE / (1 + PE / k G A)."""
    euler = factor * np.pi**2 * ALLOY.young_modulus * DEEP.inertia_z / LENGTH**2
    shear = DEEP.shear_factors[0] * ALLOY.shear_modulus * DEEP.area
    load = euler / (1 + euler / shear) if THEORIES[theory].shear else euler

    def lowest(part: float) -> float:
        return float(computed(plane_beam(theory, ends, 20, tension=-part * load), 1)[0])

    buckled = brentq(lowest, 0.9, 1.1, xtol=1e-9)
    assert buckled == pytest.approx(1.0, abs=2e-5 if theory == "euler_bernoulli" else 2e-3)
    assert lowest(0.5) > 0.0 > lowest(1.2)


def test_a_tight_bar_is_a_string() -> None:
    """omega_n = n pi / L sqrt(T / m)."""
    beam = Beam(
        "AB",
        nodes=("A", "B"),
        elements=64,
        material=ALLOY,
        section=DEEP,
        theory="bar",
        tension=1e4,
    )
    string = Structure(
        nodes={"A": (0, 0, 0), "B": (0, LENGTH, 0)},
        beams=[beam],
        supports=[
            Support(nodes=("A", "B"), fixed=("dx", "dy", "dz")),
            Support(nodes="all", fixed=("dy", "dz")),
        ],
    )
    wave = (np.arange(1, 4) * np.pi / LENGTH) ** 2 * 1e4 / (ALLOY.density * DEEP.area)
    np.testing.assert_allclose(computed(string, 3), wave, rtol=2e-3)


def test_added_mass_slows_a_beam_down() -> None:
    line = ALLOY.density * DEEP.area
    plain, loaded = (
        computed(plane_beam("euler_bernoulli", "clamped-free", 8, added_mass=mass), 3)
        for mass in (0.0, 0.7 * line)
    )
    np.testing.assert_allclose(loaded, plain / 1.7, rtol=1e-8)


def shaft(
    theory: str, spin: float, elements: int, direction: tuple[float, ...] = (1.0, 0.0, 0.0)
) -> Structure:
    """A simply supported round shaft; its free rotation is the lowest motion, without frequency."""
    beam = Beam(
        "AB",
        nodes=("A", "B"),
        elements=elements,
        material=ALLOY,
        section=Circle(radius=0.04),
        theory=theory,
        spin=spin,
    )
    return Structure(
        nodes={"A": (0, 0, 0), "B": tuple(LENGTH * np.array(direction))},
        beams=[beam],
        supports=[Support(nodes=("A", "B"), fixed=("dx", "dy", "dz"))],
    )


def whirling(structure: Structure) -> Array:
    """Frequencies of M u'' + G u' + K u = 0, ascending."""
    mass, gyroscopic, stiffness = (
        structure.reduced(matrix).to_dense()
        for matrix in (structure.mass, structure.gyroscopic, structure.stiffness)
    )
    np.testing.assert_array_equal(gyroscopic, -gyroscopic.T)
    state = np.block(
        [
            [np.zeros_like(mass), np.eye(len(mass))],
            [-np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, gyroscopic)],
        ]
    )
    rates = np.linalg.eigvals(state)
    return np.sort(rates.imag[rates.imag > 1.0])


@pytest.mark.parametrize("spin", [0.0, 3000.0, -3000.0])
def test_the_campbell_diagram_of_a_rayleigh_shaft(spin: float) -> None:
    """Mode n whirls at the roots of (m + rho I k2) w2 -+ rho Ip k2 spin w - E I k4 = 0."""
    section = Circle(radius=0.04)
    bending, line = ALLOY.young_modulus * section.inertia_z, ALLOY.density * section.area
    rotary, polar = ALLOY.density * section.inertia_z, 2 * ALLOY.density * section.inertia_z
    expected = []
    for wave in np.arange(1, 3) * np.pi / LENGTH:
        for sign in (1, -1):
            coefficients = [line + rotary * wave**2, sign * polar * wave**2 * spin]
            roots = np.roots([*coefficients, -bending * wave**4])
            expected.append(max(roots))
    found = whirling(shaft("rayleigh", spin, 20))
    for value, accuracy in zip(expected, (1e-6, 1e-6, 1e-5, 1e-5), strict=True):
        assert np.abs(found / value - 1).min() < accuracy


@pytest.mark.parametrize("spin", [0.0, 3000.0])
def test_the_campbell_diagram_of_a_timoshenko_shaft(spin: float) -> None:
    """Sines in v and cosines in the rotation: in complex form a quadratic problem of size 2."""
    section = Circle(radius=0.04)
    bending, line = ALLOY.young_modulus * section.inertia_z, ALLOY.density * section.area
    rotary, polar = ALLOY.density * section.inertia_z, 2 * ALLOY.density * section.inertia_z
    shear = section.shear_factors[0] * ALLOY.shear_modulus * section.area
    wave = np.pi / LENGTH
    stiffness = np.array(
        [[shear * wave**2, -shear * wave], [-shear * wave, shear + bending * wave**2]]
    )
    mass, gyroscopic = np.diag([line, rotary]), np.diag([0.0, polar * spin])
    expected = []
    for sign in (1, -1):  # forward and backward: w + i v ~ exp(i omega t)
        state = np.block(
            [
                [np.zeros((2, 2)), np.eye(2)],
                [np.linalg.solve(mass, stiffness), sign * np.linalg.solve(mass, gyroscopic)],
            ]
        )
        omegas = np.linalg.eigvals(state).real
        expected.append(omegas[omegas > 0].min())
    errors = np.array(
        [
            whirling(shaft("timoshenko", spin, elements))[:2] / np.sort(expected) - 1
            for elements in (14, 28)
        ]
    )
    np.testing.assert_allclose(np.log2(errors[0] / errors[1]), 2.0, atol=0.1)
    np.testing.assert_allclose(errors[1] + (errors[1] - errors[0]) / 3, 0.0, atol=1e-6)


def test_a_spinning_shaft_whirls_alike_in_any_direction() -> None:
    here, there = (
        whirling(shaft("timoshenko", 2000.0, 6, direction))[:6]
        for direction in ((1.0, 0.0, 0.0), (0.0, 0.6, 0.8))
    )
    np.testing.assert_allclose(here, there, rtol=1e-8)


def portal(turn: Array, roll: float) -> Array:
    """Lowest squared frequencies of a portal whose frame is turned in space."""
    nodes = {"A": (0, 0, 0), "B": (0, 0, 1.0), "C": (1.2, 0, 1.0), "D": (1.2, 0, 0)}
    placed = {name: tuple(turn @ np.array(place)) for name, place in nodes.items()}
    rolls = {"AB": roll, "BC": -roll, "CD": roll / 2}
    beams = [
        Beam(
            name,
            nodes=tuple(name),
            elements=3,
            material=ALLOY,
            section=Circle(radius=0.02),
            roll=angle,
        )
        for name, angle in rolls.items()
    ]
    held = Support(nodes=("A", "D"), fixed=("dx", "dy", "dz", "drx", "dry", "drz"))
    return computed(Structure(nodes=placed, beams=beams, supports=[held]), 5)


def test_a_frame_of_tubes_vibrates_alike_however_it_lies_and_its_members_roll() -> None:
    angle = 0.7
    about_x = np.array(
        [[1, 0, 0], [0, math.cos(angle), -math.sin(angle)], [0, math.sin(angle), math.cos(angle)]]
    )
    about_z = np.array(
        [[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]]
    )
    plain = portal(np.eye(3), 0.0)
    for turn, roll in ((np.eye(3), 1.1), (about_x, 0.0), (about_z @ about_x, 0.4)):
        np.testing.assert_allclose(portal(turn, roll), plain, rtol=1e-10)


def test_roll_swaps_the_sides_of_a_rectangle() -> None:
    tall, flat = Rectangle(height=0.05, width=0.02), Rectangle(height=0.02, width=0.05)

    def stiffness(section: Rectangle, roll: float) -> Array:
        beam = Beam("AB", nodes=("A", "B"), elements=1, material=ALLOY, section=section, roll=roll)
        return Structure(
            nodes={"A": (0, 0, 0), "B": (0.3, 0.4, 0.5)}, beams=[beam]
        ).stiffness.to_dense()

    expected = stiffness(flat, 0.0)
    turned = stiffness(tall, math.pi / 2)
    np.testing.assert_allclose(turned, expected, atol=1e-14 * np.abs(expected).max())
    swung = stiffness(tall, 0.3)
    np.testing.assert_array_equal(swung, swung.T)
    assert np.abs(swung - expected).max() > 1e-3 * np.abs(expected).max()
