"""Forces, strains and displacements between nodes, against beams under loads in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import bumpstop as bs
from bumpstop.problem import Load
from bumpstop.structure.dofs import DOFS

YOUNG, LENGTH, SIDE = 210e9, 2.0, 0.02
STEEL = bs.Material(young_modulus=YOUNG, poisson_ratio=0.3, density=7800.0)
BAR = bs.Rectangle(height=SIDE, width=0.5 * SIDE)
ENDS = {"A": (0.0, 0.0, 0.0), "B": (LENGTH, 0.0, 0.0)}
HINGES = (
    bs.Support(nodes="A", fixed=("dx", "dy", "dz", "drx")),
    bs.Support(nodes="B", fixed=("dy", "dz")),
)
CLAMP = (bs.Support(nodes="A", fixed=DOFS),)
PLACES = [0.0, 0.123, 0.5, 0.777, 1.0, 1.31, 1.9, 2.0]


def structure(
    supports: tuple[bs.Support, ...], elements: int = 3, theory: str = "timoshenko"
) -> bs.Structure:
    beam = bs.Beam(
        "AB", nodes=("A", "B"), elements=elements, material=STEEL, section=BAR, theory=theory
    )
    return bs.Structure(nodes=ENDS, beams=[beam], supports=supports)


def at_rest(
    supports: tuple[bs.Support, ...], *loads: Load, theory: str = "timoshenko", elements: int = 3
) -> bs.Recovery:
    """The end of a run that begins at rest under constant loads, and stays there."""
    basis = bs.ModalBasis.from_structure(structure(supports, elements, theory), modes=2)
    problem = bs.Problem(
        basis, loads=list(loads), initial=bs.StaticState(loads=list(loads)), duration=1e-3
    )
    return bs.recovery(bs.simulate(problem).at([0.0]))


def found(recovery: bs.Recovery, name: str) -> np.ndarray:
    return np.asarray(recovery.section_forces("AB", PLACES)[name].values[0])


X = np.array(PLACES)


@pytest.mark.parametrize("elements", [1, 3, 4])
def test_a_hinged_beam_under_an_even_load(elements: int) -> None:
    """V = q (L/2 - x), M = q x (L - x) / 2: the largest moment q L2 / 8 in the middle."""
    q = 30.0
    rest = at_rest(HINGES, bs.LineForce("snow", beam="AB", force=(0, -q, 0)), elements=elements)
    assert_allclose(found(rest, "Mz"), 0.5 * q * X * (LENGTH - X), atol=1e-12 * q * LENGTH**2)
    assert_allclose(found(rest, "Vy"), q * (X - 0.5 * LENGTH), atol=1e-12 * q * LENGTH)
    assert_allclose(rest.reactions("A")["dy"], 0.5 * q * LENGTH, rtol=1e-12)


@pytest.mark.parametrize("theory", ["timoshenko", "euler_bernoulli"])
def test_a_cantilever_under_its_weight_in_all_directions(theory: str) -> None:
    """N, V and M are those of what lies beyond: q (L - x), q (L - x)2 / 2."""
    a = np.array([4.0, -9.81, 2.0])
    rest = at_rest(CLAMP, bs.Gravity("weight", acceleration=tuple(a)), theory=theory)
    q, beyond = STEEL.density * BAR.area * a, LENGTH - X
    scale = 1e-12 * np.abs(q).max() * LENGTH**2
    assert_allclose(found(rest, "N"), q[0] * beyond, atol=scale)
    assert_allclose(found(rest, "Vy"), q[1] * beyond, atol=scale)
    assert_allclose(found(rest, "Vz"), q[2] * beyond, atol=scale)
    assert_allclose(found(rest, "Mz"), 0.5 * q[1] * beyond**2, atol=scale)
    assert_allclose(found(rest, "My"), -0.5 * q[2] * beyond**2, atol=scale)


def test_a_load_that_grows_along_a_part_of_the_beam() -> None:
    """From 10 N/m at 0.4 m to 40 N/m at 1.5 m; moments by its resultants beyond a section."""
    load = bs.LineForce(
        "wind", beam="AB", force=(0, 0, 10.0), end_force=(0, 0, 40.0), start=0.4, end=1.5
    )
    rest = at_rest(CLAMP, load)

    def beyond(x: float) -> tuple[float, float]:
        x = min(max(x, 0.4), 1.5)
        left = 10.0 + 30.0 * (x - 0.4) / 1.1
        length = 1.5 - x
        force = 0.5 * (left + 40.0) * length
        return force, length**2 * (left + 2.0 * 40.0) / 6.0

    shear = np.array([beyond(x)[0] for x in PLACES])
    moment = np.array([beyond(x)[1] + beyond(x)[0] * max(0.4 - x, 0.0) for x in PLACES])
    assert_allclose(found(rest, "Vz"), shear, atol=1e-10)
    assert_allclose(found(rest, "My"), -moment, atol=1e-10)


def test_a_force_and_a_moment_between_the_nodes() -> None:
    """On a hinged beam: V jumps by the force, M by the moment."""
    place, force, couple = 0.9, 50.0, 7.0
    load = bs.NodalForce("f", node=f"AB@{place}", force=(0, -force, 0), moment=(0, 0, couple))
    rest = at_rest(HINGES, load)
    support = force * (LENGTH - place) / LENGTH + couple / LENGTH
    shear = np.where(place > X, -support, force - support)
    moment = support * X - np.where(place > X, 0.0, force * (X - place) + couple)
    assert_allclose(found(rest, "Vy"), shear, atol=1e-10)
    assert_allclose(found(rest, "Mz"), moment, atol=1e-10)


def test_strains_and_stresses_follow_the_forces() -> None:
    q = 30.0
    rest = at_rest(HINGES, bs.LineForce("snow", beam="AB", force=(0, -q, 0)))
    y = -0.01
    for x in (0.3, 1.0, 1.7):
        expected = -y * 0.5 * q * x * (LENGTH - x) / BAR.inertia_z
        assert_allclose(rest.stress("AB", x, (y, 0.0)), expected, rtol=1e-11)
        assert_allclose(rest.strain("AB", x, (y, 0.0)), expected / YOUNG, rtol=1e-11)


@pytest.mark.parametrize("theory", ["timoshenko", "euler_bernoulli"])
def test_deflections_between_the_nodes(theory: str) -> None:
    """q x (L3 - 2 L x2 + x3) / 24 E I, and with shear q x (L - x) / 2 k G A more."""
    q = 30.0
    load = bs.LineForce("snow", beam="AB", force=(0, -q, 0))
    rest = at_rest(HINGES, load, theory=theory)
    shear = 1.0 / (STEEL.shear_modulus * BAR.area * BAR.shear_factors[0])
    shear = shear if theory == "timoshenko" else 0.0
    for x in (0.2, 0.5, 1.0, 1.234):
        bent = x * (LENGTH**3 - 2.0 * LENGTH * x**2 + x**3) / (24.0 * YOUNG * BAR.inertia_z)
        expected = -q * (bent + 0.5 * shear * x * (LENGTH - x))
        assert_allclose(rest.displacement(f"AB@{x}", "dy"), expected, rtol=1e-10)


def test_a_tapered_beam_under_its_weight() -> None:
    beam = bs.Beam(
        "AB",
        nodes=("A", "B"),
        elements=2,
        material=STEEL,
        section=BAR,
        end_section=bs.Rectangle(height=0.5 * SIDE, width=0.4 * SIDE),
    )
    model = bs.Structure(nodes=ENDS, beams=[beam], supports=CLAMP)
    basis = bs.ModalBasis.from_structure(model, modes=2)
    weight = bs.Gravity("weight", acceleration=(0, -9.81, 0))
    problem = bs.Problem(
        basis, loads=[weight], initial=bs.StaticState(loads=[weight]), duration=1e-3
    )
    rest = bs.recovery(bs.simulate(problem).at([0.0]))

    def mass_beyond(x: float) -> float:
        points, weights = np.polynomial.legendre.leggauss(8)
        half = 0.5 * (LENGTH - x)
        s = x + half * (1.0 + points)
        height, width = SIDE * (1.0 - 0.5 * s / LENGTH), 0.5 * SIDE * (1.0 - 0.2 * s / LENGTH)
        return float(STEEL.density * half * (weights * height * width).sum())

    expected = [-9.81 * mass_beyond(x) for x in PLACES]
    assert_allclose(found(rest, "Vy"), expected, rtol=1e-8, atol=1e-9)


def test_a_rotated_part_has_the_forces_of_the_whole() -> None:
    half = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
        beams=[bs.Beam("AB", nodes=("A", "B"), elements=2, material=STEEL, section=BAR)],
    )
    reduced = bs.craig_bampton(bs.Component(half, interface=["A", "B"]), modes=6)
    turned = bs.Rotation(axis=(0, 0, 1), angle=math.pi)
    joined = bs.Assembly(
        parts={
            "root": bs.Placed(reduced),
            "tip": bs.Placed(reduced, at=(2, 0, 0), rotation=turned),
        },
        joints=[("root.B", "tip.B")],
        supports=[bs.Support(nodes="root.A", fixed=DOFS)],
    )
    basis = bs.ModalBasis.from_structure(joined, modes=4)
    weight = bs.Gravity("weight", acceleration=(0, -9.81, 0))
    problem = bs.Problem(
        basis, loads=[weight], initial=bs.StaticState(loads=[weight]), duration=1e-3
    )
    rest = bs.recovery(bs.simulate(problem).at([0.0]))
    q = -9.81 * STEEL.density * BAR.area
    root = rest.section_forces("root.AB", 0.3)
    assert_allclose(root["Mz"], 0.5 * q * 1.7**2, rtol=1e-6)
    # Along the turned beam the part beyond is the one towards the root, and y points down.
    tip = rest.section_forces("tip.AB", 0.3)
    assert_allclose(np.abs(tip["Vy"]), abs(q) * 0.3, rtol=1e-5)
    assert_allclose(np.abs(tip["Mz"]), 0.5 * abs(q) * 0.3**2, rtol=1e-5)


def test_a_swinging_beam_has_the_forces_of_its_mode() -> None:
    """A hinged beam in its first mode, w = sin(pi x / L): M = E I (pi/L)2 w at every place.

    The elements' shapes miss the sine by (pi h / L)4; without what inertia does between the nodes
    the moment would miss by (pi h / L)2 / 8 = 1 % in the middle of an element.
    """
    basis = bs.ModalBasis.from_structure(structure(HINGES, 12, "euler_bernoulli"), modes=1)
    mid = float(basis.row("AB@1.0", "dy")[0]) or float(basis.row("AB@1.0", "dz")[0])
    start = bs.ModalState(displacement=[1e-3 / mid])
    run = bs.simulate(bs.Problem(basis, initial=start, duration=0.1))
    dof, name, inertia = (
        ("dy", "Mz", BAR.inertia_z) if basis.row("AB@1.0", "dy")[0] else ("dz", "My", BAR.inertia_y)
    )
    moments = bs.recovery(run).section_forces("AB", PLACES)[name].values
    swing = run.sample("displacement", "AB@1.0", dof)
    sign = -1.0 if name == "Mz" else 1.0
    expected = (
        sign
        * YOUNG
        * inertia
        * (math.pi / LENGTH) ** 2
        * np.outer(swing, np.sin(math.pi * X / LENGTH))
    )
    assert_allclose(moments, expected, rtol=0, atol=2e-5 * np.abs(expected).max())


def test_a_stop_between_the_nodes_bends_the_beam_there() -> None:
    """Pressed on at rest, the beam has the moment of a force in its middle, F L / 4."""
    stop = bs.Stop("prop", node="AB@1.0", normal=(0, 1, 0), gap=0.0, stiffness=1e5)
    basis = bs.ModalBasis.from_structure(
        structure(HINGES, 3), modes=3, static_shapes=[("AB@1.0", "dy")]
    )
    push = bs.LineForce("snow", beam="AB", force=(0, -80.0, 0))
    start = bs.StaticState(loads=[push], laws=[stop])
    problem = bs.Problem(basis, laws=[stop], loads=[push], initial=start, duration=1e-3)
    run = bs.simulate(problem).at([0.0])
    force = float(run.sample("stop_force", "prop")[0])
    assert force > 10.0
    expected = 80.0 * LENGTH**2 / 8.0 - force * LENGTH / 4.0
    moment = bs.recovery(run).section_forces("AB", 1.0)["Mz"]
    assert_allclose(moment, expected, rtol=1e-9)


def test_without_static_correction_elements_are_loaded_at_their_ends() -> None:
    load = bs.LineForce("snow", beam="AB", force=(0, -30.0, 0))
    rest = at_rest(HINGES, load)
    bare = bs.recovery(rest.response, static_correction=False)
    shear = bare.section_forces("AB", [0.1, 0.3, 0.6])["Vy"].values[0]
    assert np.ptp(shear) < 1e-9 * abs(shear[0])
