"""The two-node Timoshenko beam element, free of shear locking.

The displacements between the nodes are the exact static ones of a beam loaded at its ends:
cubic deflection and quadratic rotation in bending, coupled by the shear flexibility
phi = 12 E I / (k G A L2); linear stretch and twist. Stiffness is therefore exact for end
loads, and the mass matrix is consistent with the same functions, in translation and rotation.

J. S. Przemieniecki, Theory of Matrix Structural Analysis, 1968, sections 5.6 and 11.6;
Z. Friedman and J. B. Kosmatka, Computers & Structures 47 (1993) 473-481.
"""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.material import Material
from bumpstop.structure.section import Section

__all__ = ["axial_strain", "interpolation", "mass", "stiffness"]

_STRETCH = [0, 6]
_TWIST = [3, 9]
_BENDING_Y = [1, 5, 7, 11]
_BENDING_Z = [2, 4, 8, 10]
_SLOPE_SIGN = np.array([1.0, -1.0, 1.0, -1.0])
"""Deflection along z grows with a *negative* rotation about y."""


def stiffness(length: float, material: Material, section: Section) -> FloatArray:
    """Return the local stiffness matrix (12, 12), in N/m, N and N m."""
    young, shear = material.young_modulus, material.shear_modulus
    phi_y, phi_z = _shear_flexibilities(length, material, section)
    spring = np.array([[1.0, -1.0], [-1.0, 1.0]]) / length
    return _matrix(
        young * section.area * spring,
        shear * section.torsion_constant * spring,
        young * section.inertia_z * _bending_stiffness(length, phi_y),
        young * section.inertia_y * _bending_stiffness(length, phi_z),
    )


def mass(length: float, material: Material, section: Section) -> FloatArray:
    """Return the local consistent mass matrix (12, 12), in kg, kg m and kg m2."""
    density = material.density
    phi_y, phi_z = _shear_flexibilities(length, material, section)
    linear = length / 6.0 * np.array([[2.0, 1.0], [1.0, 2.0]])
    translation_y = section.area * _translational_mass(length, phi_y)
    translation_z = section.area * _translational_mass(length, phi_z)
    return density * _matrix(
        section.area * linear,
        (section.inertia_y + section.inertia_z) * linear,
        translation_y + section.inertia_z * _rotary_mass(length, phi_y),
        translation_z + section.inertia_y * _rotary_mass(length, phi_z),
    )


def interpolation(xi: float, length: float, material: Material, section: Section) -> FloatArray:
    """Return displacements and rotations at ``xi`` in [0, 1] by the local dofs, (6, 12)."""
    phi_y, phi_z = _shear_flexibilities(length, material, section)
    functions = np.zeros((6, 12))
    functions[0, _STRETCH] = functions[3, _TWIST] = 1.0 - xi, xi
    functions[1, _BENDING_Y] = _deflection(xi, length, phi_y)
    functions[5, _BENDING_Y] = _rotation(xi, length, phi_y)
    functions[2, _BENDING_Z] = _SLOPE_SIGN * _deflection(xi, length, phi_z)
    functions[4, _BENDING_Z] = -_SLOPE_SIGN * _rotation(xi, length, phi_z)
    return functions


def axial_strain(
    xi: float,
    fibre: tuple[float, float],
    length: float,
    material: Material,
    section: Section,
) -> FloatArray:
    """Return the axial strain u' - y drz' + z dry' at ``xi`` by the local dofs, (12,), in 1/m.

    ``fibre`` is (y, z) in m from the section's centroid, in local axes.
    """
    y, z = fibre
    phi_y, phi_z = _shear_flexibilities(length, material, section)
    strain = np.zeros(12)
    strain[_STRETCH] = -1.0 / length, 1.0 / length
    strain[_BENDING_Y] = -y * _curvature(xi, length, phi_y)
    strain[_BENDING_Z] = -z * _SLOPE_SIGN * _curvature(xi, length, phi_z)
    return strain


def _shear_flexibilities(
    length: float, material: Material, section: Section
) -> tuple[float, float]:
    """Return phi of bending along local y and along local z: bending over shear stiffness."""
    ratio = 12.0 * material.young_modulus / (material.shear_modulus * section.area * length**2)
    factor_y, factor_z = section.shear_factors
    return ratio * section.inertia_z / factor_y, ratio * section.inertia_y / factor_z


def _matrix(
    stretch: FloatArray, twist: FloatArray, bending_y: FloatArray, bending_z: FloatArray
) -> FloatArray:
    """Place the four independent blocks in a (12, 12) matrix."""
    matrix = np.zeros((12, 12))
    matrix[np.ix_(_STRETCH, _STRETCH)] = stretch
    matrix[np.ix_(_TWIST, _TWIST)] = twist
    matrix[np.ix_(_BENDING_Y, _BENDING_Y)] = bending_y
    matrix[np.ix_(_BENDING_Z, _BENDING_Z)] = np.outer(_SLOPE_SIGN, _SLOPE_SIGN) * bending_z
    return matrix


# Below, for bending along y: rows and columns are deflection and rotation of the first node
# and then of the second.


def _bending_stiffness(length: float, phi: float) -> FloatArray:
    """Return the bending stiffness for E I = 1, (4, 4)."""
    force, couple = 12.0, 6.0 * length
    near, far = (4.0 + phi) * length**2, (2.0 - phi) * length**2
    return np.array(
        [
            [force, couple, -force, couple],
            [couple, near, -couple, far],
            [-force, -couple, force, -couple],
            [couple, far, -couple, near],
        ]
    ) / (length**3 * (1.0 + phi))


def _translational_mass(length: float, phi: float) -> FloatArray:
    """Return the mass of the deflection for rho A = 1, (4, 4)."""
    own = 13.0 / 35.0 + 7.0 / 10.0 * phi + phi**2 / 3.0
    other = 9.0 / 70.0 + 3.0 / 10.0 * phi + phi**2 / 6.0
    near = (11.0 / 210.0 + 11.0 / 120.0 * phi + phi**2 / 24.0) * length
    far = (13.0 / 420.0 + 3.0 / 40.0 * phi + phi**2 / 24.0) * length
    turn = (1.0 / 105.0 + phi / 60.0 + phi**2 / 120.0) * length**2
    cross = (1.0 / 140.0 + phi / 60.0 + phi**2 / 120.0) * length**2
    return np.array(
        [
            [own, near, other, -far],
            [near, turn, far, -cross],
            [other, far, own, -near],
            [-far, -cross, -near, turn],
        ]
    ) * (length / (1.0 + phi) ** 2)


def _rotary_mass(length: float, phi: float) -> FloatArray:
    """Return the mass of the rotation for rho I = 1, (4, 4)."""
    slope = 6.0 / 5.0
    couple = (1.0 / 10.0 - phi / 2.0) * length
    near = (2.0 / 15.0 + phi / 6.0 + phi**2 / 3.0) * length**2
    far = (-1.0 / 30.0 - phi / 6.0 + phi**2 / 6.0) * length**2
    return np.array(
        [
            [slope, couple, -slope, couple],
            [couple, near, -couple, far],
            [-slope, -couple, slope, -couple],
            [couple, far, -couple, near],
        ]
    ) / (length * (1.0 + phi) ** 2)


# The polynomials are written as products, so that they are exactly 0 or 1 at the nodes.


def _deflection(xi: float, length: float, phi: float) -> FloatArray:
    """Return the deflection at ``xi`` by the four bending dofs."""
    rest = 1.0 - xi
    return np.array(
        [
            rest * (1.0 + xi - 2.0 * xi**2 + phi),
            length * xi * rest * (rest + phi / 2.0),
            xi * (3.0 * xi - 2.0 * xi**2 + phi),
            -length * xi * rest * (xi + phi / 2.0),
        ]
    ) / (1.0 + phi)


def _rotation(xi: float, length: float, phi: float) -> FloatArray:
    """Return the rotation of the section at ``xi`` by the four bending dofs."""
    rest = 1.0 - xi
    return np.array(
        [
            -6.0 * xi * rest / length,
            rest * (1.0 - 3.0 * xi + phi),
            6.0 * xi * rest / length,
            xi * (3.0 * xi - 2.0 + phi),
        ]
    ) / (1.0 + phi)


def _curvature(xi: float, length: float, phi: float) -> FloatArray:
    """Return the derivative of the rotation along the beam by the four bending dofs."""
    return np.array(
        [
            6.0 * (2.0 * xi - 1.0) / length,
            6.0 * xi - 4.0 - phi,
            6.0 * (1.0 - 2.0 * xi) / length,
            6.0 * xi - 2.0 + phi,
        ]
    ) / (length * (1.0 + phi))
