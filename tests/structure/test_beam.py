from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from bumpstop import Beam, Gauge, InputError, Material, Rectangle, Structure, Support
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.elements import prismatic
from bumpstop.structure.frame import local_axes

Array = NDArray[np.float64]
Cantilever = Callable[..., Structure]

STEEL = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
BAR = Rectangle(height=0.06, width=0.025)

coordinate = st.floats(-3.0, 3.0)
directions = st.tuples(coordinate, coordinate, coordinate)
few = settings(max_examples=30, derandomize=True, deadline=None)


def built(start: Array, end: Array, section: Rectangle = BAR, elements: int = 3) -> Structure:
    return Structure(
        nodes={"A": tuple(start), "B": tuple(end)},
        beams=[Beam("AB", nodes=("A", "B"), elements=elements, material=STEEL, section=section)],
        supports=[Support(nodes=("A",), fixed=DOFS)],
    )


def deflected(structure: Structure, force: Array, moment: Array | None = None) -> Array:
    """Static displacements of all dofs under loads at node B."""
    load = np.zeros(len(structure.dofs))
    first = structure.dofs.index(("B", "dx"))
    load[first : first + 3] = force
    load[first + 3 : first + 6] = 0.0 if moment is None else moment
    free = structure.free
    result = np.zeros_like(load)
    stiffness = structure.stiffness.to_dense()[np.ix_(free, free)]
    result[free] = np.linalg.solve(stiffness, load[free])
    return result


def at(structure: Structure, field: Array, node: str) -> Array:
    return np.array([structure.displacement_form(node, dof).of(field) for dof in DOFS])


@few
@given(direction=directions, elements=st.integers(1, 4))
def test_tip_of_a_cantilever_in_any_direction(
    direction: tuple[float, float, float], elements: int
) -> None:
    """Theory: P L3 / 3 E I + P L / k G A sideways, P L / E A along, T L / G J in twist."""
    start, end = np.array([0.3, -1.0, 2.0]), np.array([0.3, -1.0, 2.0]) + direction
    length = float(np.linalg.norm(direction))
    assume(length > 0.2)
    structure = built(start, end, elements=elements)
    x, y, z = local_axes(start, end)
    young, shear = STEEL.young_modulus, STEEL.shear_modulus
    slide = length / (5 / 6 * shear * BAR.area)
    for axis, inertia in ((y, BAR.inertia_z), (z, BAR.inertia_y)):
        tip = at(structure, deflected(structure, 1000.0 * axis), "B")
        expected = 1000.0 * (length**3 / (3 * young * inertia) + slide) * axis
        np.testing.assert_allclose(tip[:3], expected, atol=1e-10 * np.abs(expected).max())
        turned = 1000.0 * length**2 / (2 * young * inertia) * np.cross(x, axis)
        np.testing.assert_allclose(tip[3:], turned, atol=1e-10 * np.abs(turned).max())
    stretch = at(structure, deflected(structure, 1000.0 * x), "B")[:3]
    expected = 1000.0 * length / (young * BAR.area) * x
    np.testing.assert_allclose(stretch, expected, atol=1e-9 * np.abs(expected).max())
    twist = at(structure, deflected(structure, np.zeros(3), 10.0 * x), "B")[3:]
    expected = 10.0 * length / (shear * BAR.torsion_constant) * x
    np.testing.assert_allclose(twist, expected, atol=1e-9 * np.abs(expected).max())


@few
@given(direction=directions)
def test_local_axes_are_a_right_handed_frame(direction: tuple[float, float, float]) -> None:
    end = np.array(direction)
    length = float(np.linalg.norm(end))
    assume(length > 1e-3)
    axes = local_axes(np.zeros(3), end)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-14)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    np.testing.assert_allclose(axes[0] * length, end, atol=1e-14 * length)
    assert axes[2, 2] > -1e-6  # z points up, or is level for an upright member
    assert abs(axes[1, 2]) < 1e-15  # y is level


@pytest.mark.parametrize(
    ("end", "axes"),
    [
        ((0.7, 0, 0), [[1, 0, 0], [0, 1, 0], [0, 0, 1]]),
        ((-0.7, 0, 0), [[-1, 0, 0], [0, -1, 0], [0, 0, 1]]),
        ((0, 0.3, 0), [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]),
        ((0, 0, 0.1), [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]),
        ((0, 0, -0.1), [[0, 0, -1], [0, 1, 0], [1, 0, 0]]),
    ],
)
def test_axes_of_members_along_an_axis_are_exact(
    end: tuple[float, float, float], axes: list[list[int]]
) -> None:
    np.testing.assert_array_equal(local_axes(np.zeros(3), np.array(end)), axes)


def test_matrices_along_x_are_those_of_the_element_to_the_bit(cantilever: Cantilever) -> None:
    structure = cantilever(elements=1)
    beam = structure.beams[0]
    expected = prismatic.stiffness(1.0, beam.slice_at(0.0))
    np.testing.assert_array_equal(structure.stiffness.to_dense(), expected)
    expected = prismatic.mass(1.0, beam.slice_at(0.0))
    np.testing.assert_array_equal(structure.mass.to_dense(), expected)


@few
@given(angle=st.floats(-3.2, 3.2), end=directions)
def test_turning_about_z_turns_the_answer(angle: float, end: tuple[float, float, float]) -> None:
    start, tip = np.array([0.1, 0.2, 0.3]), np.array(end)
    assume(np.hypot(*(tip - start)[:2]) > 0.1)
    turn = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    )
    force = np.array([30.0, -700.0, 200.0])
    here = built(start, tip)
    there = built(turn @ start, turn @ tip)
    still = at(here, deflected(here, force), "B")
    turned = at(there, deflected(there, turn @ force), "B")
    for part in (slice(0, 3), slice(3, 6)):
        scale = np.abs(still[part]).max()
        np.testing.assert_allclose(turned[part], turn @ still[part], atol=1e-9 * scale)


@few
@given(end=directions)
def test_mass_totals_in_any_direction(end: tuple[float, float, float]) -> None:
    tip = np.array(end)
    length = float(np.linalg.norm(tip))
    assume(length > 0.2)
    structure = built(np.zeros(3), tip, elements=2)
    x, y, z = local_axes(np.zeros(3), tip)
    total = STEEL.density * BAR.area * length

    def energy(**motion: tuple[float, ...]) -> float:
        field = structure.rigid_field(**motion)  # type: ignore[arg-type]  # three numbers each
        return float(field @ (structure.mass @ field))

    assert energy(translation=(0.0, 1.0, 0.0)) == pytest.approx(total, rel=1e-12)
    centre = tuple(tip / 2)
    line = STEEL.density * length
    slender = total * length**2 / 12
    for axis, inertia in (
        (x, line * (BAR.inertia_y + BAR.inertia_z)),
        (y, line * BAR.inertia_y + slender),
        (z, line * BAR.inertia_z + slender),
    ):
        assert energy(rotation=tuple(axis), about=centre) == pytest.approx(inertia, rel=1e-9)


def test_inner_nodes_have_names_and_even_places(cantilever: Cantilever) -> None:
    structure = cantilever(tip=(0.0, 2.0, 0.0), elements=4)
    assert structure.mesh.names == ("A", "B", "AB.1", "AB.2", "AB.3")
    np.testing.assert_array_equal(structure.mesh.positions[2:, 1], [0.5, 1.0, 1.5])
    assert structure.position("AB.3") == (0.0, 1.5, 0.0)
    assert structure.position("AB@0.75") == (0.0, 0.75, 0.0)


def test_points_on_mesh_nodes_are_the_nodes(cantilever: Cantilever) -> None:
    structure = cantilever(tip=(1.0, 0.0, 0.0), elements=4)
    field = np.random.default_rng(1).normal(size=len(structure.dofs))
    for point, node in (("AB@0", "A"), ("AB@0.25", "AB.1"), ("AB@75 cm", "AB.3"), ("AB@1 m", "B")):
        np.testing.assert_array_equal(at(structure, field, point), at(structure, field, node))


def test_points_between_nodes_follow_the_static_deflection(cantilever: Cantilever) -> None:
    length, force = 1.0, -500.0
    structure = cantilever(elements=2)
    field = deflected(structure, np.array([0.0, force, 0.0]))
    bending = STEEL.young_modulus * BAR.inertia_z
    shear = 5 / 6 * STEEL.shear_modulus * BAR.area
    for s in (0.1, 0.37, 0.5, 0.81):
        deflection = force * (s**2 * (3 * length - s) / (6 * bending) + s / shear)
        rotation = force * s * (2 * length - s) / (2 * bending)
        here = at(structure, field, f"AB@{s}")
        np.testing.assert_allclose(here[[1, 5]], [deflection, rotation], rtol=1e-11)


@pytest.mark.parametrize("tip", [(1.0, 0.0, 0.0), (0.3, -0.5, 0.8), (0.0, 0.0, 1.5)])
def test_a_gauge_reads_the_stretch_of_its_fibre(
    cantilever: Cantilever, tip: tuple[float, float, float]
) -> None:
    """Differences of the displacements of two points on the fibre, exact for a quadratic."""
    structure = cantilever(tip=tip, elements=3)
    field = np.random.default_rng(2).normal(size=len(structure.dofs))
    x, y, z = local_axes(np.zeros(3), np.array(tip))
    fibre = (0.021, -0.008)
    arm = fibre[0] * y + fibre[1] * z

    def along(s: float) -> float:
        here = at(structure, field, f"AB@{s!r}")
        return float(x @ (here[:3] + np.cross(here[3:], arm)))

    step = 0.01
    for s in (0.1, 0.6, 0.77):
        gauge = Gauge("g", beam="AB", at=s, fibre=fibre)
        difference = (along(s + step) - along(s - step)) / (2 * step)
        assert structure.strain_form(gauge).of(field) == pytest.approx(difference, rel=1e-10)


def test_a_gauge_on_a_static_cantilever(cantilever: Cantilever) -> None:
    """Strain is -M y / E I from bending along y and N / E A from the pull."""
    force, pull, length = -500.0, 2000.0, 1.0
    structure = cantilever(elements=3)
    field = deflected(structure, np.array([pull, force, 0.0]))
    for s in (0.0, 0.2, 1 / 3, 0.55, 1.0):
        gauge = Gauge("g", beam="AB", at=s, fibre=(0.03, 0.0))
        moment = force * (length - s)
        expected = pull / (STEEL.young_modulus * BAR.area) - 0.03 * moment / (
            STEEL.young_modulus * BAR.inertia_z
        )
        assert structure.strain_form(gauge).of(field) == pytest.approx(expected, rel=1e-10)


def test_a_gauge_outside_the_section_or_the_beam_is_refused(cantilever: Cantilever) -> None:
    structure = cantilever()
    with pytest.raises(InputError, match="fibre: is outside the section"):
        structure.strain_form(Gauge("g", beam="AB", at=0.5, fibre=(0.3, 0.0)))
    with pytest.raises(InputError, match=r"at: must be on the beam, which is 1 m long \(got 1.1\)"):
        structure.strain_form(Gauge("g", beam="AB", at=1.1, fibre=(0.0, 0.0)))
    with pytest.raises(InputError, match=r"beam: unknown beam .*did you mean 'AB'"):
        structure.strain_form(Gauge("g", beam="ABC", at=0.5, fibre=(0.0, 0.0)))
