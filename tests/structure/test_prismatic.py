"""The element against a derivation that shares none of its formulas.

Deflections are cubic polynomials v; equilibrium of an element loaded at its ends gives the
rotation v' + E I / (k G A) v'''. Coefficients follow from the end values, and matrices from
integrals of the polynomials, all in 40-digit arithmetic.
"""

from __future__ import annotations

from typing import Any

import mpmath as mp
import numpy as np
import pytest
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from bumpstop import Material, Rectangle
from bumpstop.structure.elements import THEORIES, prismatic

Array = NDArray[np.float64]

LENGTH = 0.4
MATERIAL = Material(young_modulus=70e9, poisson_ratio=0.33, density=2700.0)
SECTION = Rectangle(height=0.11, width=0.05, shear_factors=(0.85, 0.7))
PART = (LENGTH, THEORIES["timoshenko"].slice_of(MATERIAL, SECTION, 0.0))

BENDING_Y = [1, 5, 7, 11]
BENDING_Z = [2, 4, 8, 10]
# Bending along z: with psi = -dry for a rotation, it is bending along y.
SIGNS_Z = np.diag([1.0, -1.0, 1.0, -1.0])

PLANES = [
    pytest.param(BENDING_Y, np.eye(4), SECTION.inertia_z, 0.85, id="along-y"),
    pytest.param(BENDING_Z, SIGNS_Z, SECTION.inertia_y, 0.7, id="along-z"),
]


class ExactBending:
    def __init__(self, inertia: float, factor: float) -> None:
        self.length = mp.mpf(LENGTH)
        self.bending = mp.mpf(MATERIAL.young_modulus) * mp.mpf(inertia)
        self.shear = mp.mpf(factor) * mp.mpf(MATERIAL.shear_modulus) * mp.mpf(SECTION.area)
        self.line_mass = mp.mpf(MATERIAL.density) * mp.mpf(SECTION.area)
        self.line_inertia = mp.mpf(MATERIAL.density) * mp.mpf(inertia)
        monomials = [self._fields([mp.mpf(i == j) for j in range(4)]) for i in range(4)]
        ends = mp.matrix(4, 4)
        for j, (deflection, rotation, _, _) in enumerate(monomials):
            for i, value in enumerate(
                (deflection(0), rotation(0), deflection(self.length), rotation(self.length))
            ):
                ends[i, j] = value
        inverse = ends**-1
        self.functions = [self._fields([inverse[i, j] for i in range(4)]) for j in range(4)]

    def _fields(self, coefficients: list[Any]) -> tuple[Polynomial, ...]:
        """Deflection, rotation, curvature and shear strain."""
        deflection = Polynomial(np.array(coefficients, dtype=object))
        slope = deflection.deriv()
        rotation = slope + self.bending / self.shear * deflection.deriv(3)
        return deflection, rotation, rotation.deriv(), slope - rotation

    def matrix(self, weights: tuple[Any, Any, Any, Any]) -> Array:
        """Integral of the products of two functions' fields, each with its weight."""
        result = np.zeros((4, 4))
        for i, first in enumerate(self.functions):
            for j, second in enumerate(self.functions):
                pairs = zip(weights, first, second, strict=True)
                products = [weight * (a * b) for weight, a, b in pairs if weight]
                result[i, j] = sum(p.integ()(self.length) - p.integ()(0) for p in products)
        return result

    def at(self, xi: float) -> Array:
        """Deflection, rotation and curvature at xi by the four end values."""
        place = mp.mpf(xi) * self.length
        return np.array([[float(f[k](place)) for f in self.functions] for k in range(3)])


@pytest.fixture(autouse=True)
def _digits() -> Any:
    with mp.workdps(40):
        yield


@pytest.mark.parametrize(("dofs", "signs", "inertia", "factor"), PLANES)
def test_bending_matrices(dofs: list[int], signs: Array, inertia: float, factor: float) -> None:
    exact = ExactBending(inertia, factor)
    stiffness = exact.matrix((0, 0, exact.bending, exact.shear))
    mass = exact.matrix((exact.line_mass, exact.line_inertia, 0, 0))
    for computed, expected in (
        (prismatic.stiffness(*PART), stiffness),
        (prismatic.mass(*PART), mass),
    ):
        block = computed[np.ix_(dofs, dofs)]
        scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
        np.testing.assert_allclose(block / scale, signs @ expected @ signs / scale, atol=1e-14)


@pytest.mark.parametrize(("dofs", "signs", "inertia", "factor"), PLANES)
@pytest.mark.parametrize("xi", [0.0, 0.137, 0.5, 0.9, 1.0])
def test_bending_interpolation(
    dofs: list[int], signs: Array, inertia: float, factor: float, xi: float
) -> None:
    deflection, rotation, curvature = ExactBending(inertia, factor).at(xi) @ signs
    functions = prismatic.interpolation(xi, *PART)
    along_y = dofs == BENDING_Y
    np.testing.assert_allclose(functions[1 if along_y else 2, dofs], deflection, atol=1e-14)
    turned = functions[5, dofs] if along_y else -functions[4, dofs]
    np.testing.assert_allclose(turned, rotation, atol=1e-13)
    fibre = (1.0, 0.0) if along_y else (0.0, 1.0)
    strain = prismatic.axial_strain(xi, fibre, *PART)
    np.testing.assert_allclose(strain[dofs], -curvature, rtol=1e-12, atol=1e-11)


@pytest.mark.parametrize(("dofs", "signs", "inertia", "factor"), PLANES)
def test_stiffness_is_the_inverse_of_the_flexibility_of_a_cantilever(
    dofs: list[int], signs: Array, inertia: float, factor: float
) -> None:
    bending = MATERIAL.young_modulus * inertia
    shear = factor * MATERIAL.shear_modulus * SECTION.area
    flexibility = np.array(
        [
            [LENGTH**3 / (3 * bending) + LENGTH / shear, LENGTH**2 / (2 * bending)],
            [LENGTH**2 / (2 * bending), LENGTH / bending],
        ]
    )
    tip = prismatic.stiffness(*PART)[np.ix_(dofs[2:], dofs[2:])]
    signs = signs[2:, 2:]
    np.testing.assert_allclose(tip @ signs @ flexibility @ signs, np.eye(2), atol=1e-11)


def test_stretch_and_twist() -> None:
    stiffness, mass = prismatic.stiffness(*PART), prismatic.mass(*PART)
    axial = MATERIAL.young_modulus * SECTION.area / LENGTH
    torsional = MATERIAL.shear_modulus * SECTION.torsion_constant / LENGTH
    polar = MATERIAL.density * (SECTION.inertia_y + SECTION.inertia_z) * LENGTH
    spring, bar = np.array([[1, -1], [-1, 1]]), np.array([[2, 1], [1, 2]]) / 6
    for dofs, k, m in (
        ([0, 6], axial, MATERIAL.density * SECTION.area * LENGTH),
        ([3, 9], torsional, polar),
    ):
        np.testing.assert_allclose(stiffness[np.ix_(dofs, dofs)], k * spring, rtol=1e-14)
        np.testing.assert_allclose(mass[np.ix_(dofs, dofs)], m * bar, rtol=1e-14)


def test_matrices_are_symmetric_and_mass_is_positive() -> None:
    stiffness, mass = prismatic.stiffness(*PART), prismatic.mass(*PART)
    np.testing.assert_array_equal(stiffness, stiffness.T)
    np.testing.assert_array_equal(mass, mass.T)
    assert np.linalg.eigvalsh(mass).min() > 0.0


def rigid_motions() -> Array:
    """Six rigid motions of the two nodes, about the first."""
    motions = np.zeros((12, 6))
    motions[:6] = np.eye(6)
    motions[6:] = np.eye(6)
    motions[7, 5], motions[8, 4] = LENGTH, -LENGTH
    return motions


def test_rigid_motions_strain_nothing_and_are_interpolated_exactly() -> None:
    motions = rigid_motions()
    forces = prismatic.stiffness(*PART) @ motions
    largest = np.abs(prismatic.stiffness(*PART)).max()
    assert np.abs(forces).max() < 1e-15 * largest
    assert np.linalg.matrix_rank(prismatic.stiffness(*PART) / largest, tol=1e-12) == 6
    xi = 0.3
    expected = np.eye(6)
    expected[1, 5], expected[2, 4] = xi * LENGTH, -xi * LENGTH
    np.testing.assert_allclose(prismatic.interpolation(xi, *PART) @ motions, expected, atol=1e-15)
    strain = prismatic.axial_strain(xi, (0.03, 0.01), *PART)
    np.testing.assert_allclose(strain @ motions, 0.0, atol=1e-14)


@pytest.mark.parametrize(("xi", "dofs"), [(0.0, slice(0, 6)), (1.0, slice(6, 12))])
def test_interpolation_is_exactly_one_at_its_own_node(xi: float, dofs: slice) -> None:
    expected = np.zeros((6, 12))
    expected[:, dofs] = np.eye(6)
    np.testing.assert_array_equal(prismatic.interpolation(xi, *PART), expected)


def test_constant_curvature_and_stretch_are_exact() -> None:
    """The patch test: end values of a pure bending field give its strain everywhere."""
    stretch, about_y, about_z = 1e-4, 2e-3, -3e-3
    ends = np.zeros(12)
    ends[6] = stretch * LENGTH
    ends[7], ends[11] = about_z * LENGTH**2 / 2, about_z * LENGTH
    ends[8], ends[10] = -about_y * LENGTH**2 / 2, about_y * LENGTH
    for xi in (0.0, 0.2, 0.77, 1.0):
        y, z = 0.04, -0.02
        strain = prismatic.axial_strain(xi, (y, z), *PART) @ ends
        assert strain == pytest.approx(stretch - y * about_z + z * about_y, rel=1e-12)


def test_mass_moves_as_a_rigid_body() -> None:
    motions = rigid_motions()
    mass = motions.T @ prismatic.mass(*PART) @ motions
    total = MATERIAL.density * SECTION.area * LENGTH
    inertia = (
        MATERIAL.density
        * LENGTH
        * np.array([SECTION.inertia_y + SECTION.inertia_z, SECTION.inertia_y, SECTION.inertia_z])
    )
    inertia[1:] += total * LENGTH**2 / 3
    np.testing.assert_allclose(np.diag(mass), [total] * 3 + list(inertia), rtol=1e-13)
    assert mass[1, 5] == pytest.approx(total * LENGTH / 2, rel=1e-13)
    assert mass[2, 4] == pytest.approx(-total * LENGTH / 2, rel=1e-13)
