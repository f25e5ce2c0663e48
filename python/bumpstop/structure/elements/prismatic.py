"""The two-node beam element of constant section, free of shear locking.

The displacements between the nodes are the exact static ones of a beam loaded at its ends:
cubic deflection and quadratic rotation in bending, coupled by the shear flexibility
phi = 12 E I / (k G A L2); linear stretch and twist. Stiffness is therefore exact for end
loads, and the mass matrix is consistent with the same functions, in translation and rotation.
Without shear strain phi is 0, and the functions are the cubics of Hermite.

Lengths and the fields of a slice are numbers, or arrays of one number an element; matrices
have as many more axes before their two.

J. S. Przemieniecki, Theory of Matrix Structural Analysis, 1968, sections 5.6, 11.6, chapter 15;
Z. Friedman and J. B. Kosmatka, Computers & Structures 47 (1993) 473-481.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.elements.slice import Slice

__all__ = [
    "axial_strain",
    "geometric_stiffness",
    "gyroscopic",
    "interpolation",
    "lumped_mass",
    "mass",
    "stiffness",
]

Numbers: TypeAlias = Any
"""A float, or an array of one number an element."""

_STRETCH = [0, 6]
_TWIST = [3, 9]
_BENDING_Y = [1, 5, 7, 11]
_BENDING_Z = [2, 4, 8, 10]
_SLOPE_SIGN = np.array([1.0, -1.0, 1.0, -1.0])
"""Deflection along z grows with a *negative* rotation about y."""

_GAUSS_3 = ((0.5 - 0.15**0.5, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.5 + 0.15**0.5, 5.0 / 18.0))
"""Points and weights on [0, 1] that integrate polynomials up to degree five exactly."""


def stiffness(length: Numbers, part: Slice) -> FloatArray:
    """Return the local stiffness matrix (12, 12), in N/m, N and N m."""
    phi_y, phi_z = _shear_flexibilities(length, part)
    return _matrix(
        part.young * part.area * _spring(length),
        part.shear * part.torsion_constant * _spring(length),
        part.young * part.inertia_z * _bending_stiffness(length, phi_y),
        part.young * part.inertia_y * _bending_stiffness(length, phi_z),
    )


def mass(length: Numbers, part: Slice) -> FloatArray:
    """Return the local consistent mass matrix (12, 12), in kg, kg m and kg m2."""
    phi_y, phi_z = _shear_flexibilities(length, part)
    density, area = part.density, part.mass_area
    bending_y = area * _translational_mass(length, phi_y) + part.rotary_z * _rotary_mass(
        length, phi_y
    )
    bending_z = area * _translational_mass(length, phi_z) + part.rotary_y * _rotary_mass(
        length, phi_z
    )
    return _matrix(
        density * (area * _bar_mass(length)),
        density * ((part.inertia_y + part.inertia_z) * _bar_mass(length)),
        density * bending_y,
        density * bending_z,
    )


def lumped_mass(length: Numbers, part: Slice) -> FloatArray:
    """Return the local diagonal mass matrix (12, 12): half of the element at each node.

    Nodes turn with the rotary inertia of half the element's sections. Where the theory has
    none, with m L3 / 78, what scaling the diagonal of the consistent matrix to the right mass
    leaves (E. Hinton, T. Rock and O. C. Zienkiewicz, Earthquake Engineering & Structural
    Dynamics 4 (1976) 245-249); it vanishes as the mesh is refined.
    """
    half = 0.5 * part.density * length
    without = part.mass_area * length**2 / 39.0
    rotary_y, rotary_z = (
        np.where(np.equal(inertia, 0.0), without, inertia)
        for inertia in (part.rotary_y, part.rotary_z)
    )
    node = [part.mass_area] * 3 + [part.inertia_y + part.inertia_z, rotary_y, rotary_z]
    matrix = np.zeros((*np.shape(length), 12, 12))
    for number, value in enumerate(node * 2):
        matrix[..., number, number] = half * value
    return matrix


def geometric_stiffness(length: Numbers, part: Slice, tension: Numbers) -> FloatArray:
    """Return what an axial force, positive in tension, adds to the stiffness, (12, 12).

    It is the work of the even axial stress on the slopes of all fibres; in twist this is the
    force times the squared radius of gyration.
    """
    phi_y, phi_z = _shear_flexibilities(length, part)
    polar = (part.inertia_y + part.inertia_z) / part.area
    return _matrix(
        0.0 * _spring(length),
        tension * polar * _spring(length),
        tension * _slope_stiffness(length, phi_y),
        tension * _slope_stiffness(length, phi_z),
    )


def gyroscopic(length: Numbers, part: Slice, spin: Numbers) -> FloatArray:
    """Return the skew-symmetric gyroscopic matrix (12, 12) of a shaft that spins about x.

    The sections' angular momentum, spin times polar inertia along the axis of the shaft,
    turns with the axis (H. D. Nelson, Journal of Mechanical Design 102 (1980) 793-803).
    """
    phi_y, phi_z = _shear_flexibilities(length, part)
    momentum = part.density * (part.inertia_y + part.inertia_z) * spin * length
    matrix = np.zeros((*np.shape(length), 12, 12))
    _place(matrix, _BENDING_Z, _BENDING_Y, momentum * _turning(length, phi_y, phi_z))
    return matrix - np.swapaxes(matrix, -1, -2)


def interpolation(xi: float, length: float, part: Slice) -> FloatArray:
    """Return displacements and rotations at ``xi`` in [0, 1] by the local dofs, (6, 12)."""
    phi_y, phi_z = _shear_flexibilities(length, part)
    functions = np.zeros((6, 12))
    functions[0, _STRETCH] = functions[3, _TWIST] = 1.0 - xi, xi
    functions[1, _BENDING_Y] = _deflection(xi, length, phi_y)
    functions[5, _BENDING_Y] = _rotation(xi, length, phi_y)
    functions[2, _BENDING_Z] = _SLOPE_SIGN * _deflection(xi, length, phi_z)
    functions[4, _BENDING_Z] = -_SLOPE_SIGN * _rotation(xi, length, phi_z)
    return functions


def axial_strain(xi: float, fibre: tuple[float, float], length: float, part: Slice) -> FloatArray:
    """Return the axial strain u' - y drz' + z dry' at ``xi`` by the local dofs, (12,), in 1/m.

    ``fibre`` is (y, z) in m from the section's centroid, in local axes.
    """
    y, z = fibre
    phi_y, phi_z = _shear_flexibilities(length, part)
    strain = np.zeros(12)
    strain[_STRETCH] = -1.0 / length, 1.0 / length
    strain[_BENDING_Y] = -y * _curvature(xi, length, phi_y)
    strain[_BENDING_Z] = -z * _SLOPE_SIGN * _curvature(xi, length, phi_z)
    return strain


def _shear_flexibilities(length: Numbers, part: Slice) -> tuple[Numbers, Numbers]:
    """Return phi of bending along local y and along local z: bending over shear stiffness."""
    ratio = 12.0 * part.young / (part.shear * part.area * length**2)
    return ratio * part.inertia_z / part.factor_y, ratio * part.inertia_y / part.factor_z


def _matrix(
    stretch: FloatArray, twist: FloatArray, bending_y: FloatArray, bending_z: FloatArray
) -> FloatArray:
    """Place the four independent blocks in a matrix (12, 12)."""
    signs = _beside(np.outer(_SLOPE_SIGN, _SLOPE_SIGN), bending_z)
    matrix = np.zeros((*stretch.shape[2:], 12, 12))
    _place(matrix, _STRETCH, _STRETCH, stretch)
    _place(matrix, _TWIST, _TWIST, twist)
    _place(matrix, _BENDING_Y, _BENDING_Y, bending_y)
    _place(matrix, _BENDING_Z, _BENDING_Z, signs * bending_z)
    return matrix


def _place(matrix: FloatArray, rows: list[int], columns: list[int], block: FloatArray) -> None:
    """Write a block, whose elements are in its last axis, into a matrix, with them in its first."""
    matrix[..., np.array(rows)[:, np.newaxis], columns] = np.moveaxis(block, (0, 1), (-2, -1))


def _beside(plain: FloatArray, block: FloatArray) -> FloatArray:
    """Return an array with axes of length one for the elements of a block."""
    return plain.reshape(plain.shape + (1,) * (np.ndim(block) - plain.ndim))


# Below, blocks have the elements in their last axis. In bending along y, rows and columns are
# deflection and rotation of the first node and then of the second.


def _spring(length: Numbers) -> FloatArray:
    """Return the stiffness of stretch for E A = 1, (2, 2)."""
    constant = 1.0 / length
    return np.array([[constant, -constant], [-constant, constant]])


def _bar_mass(length: Numbers) -> FloatArray:
    """Return the mass of stretch for rho A = 1, (2, 2)."""
    sixth = length / 6.0
    return np.array([[2.0 * sixth, sixth], [sixth, 2.0 * sixth]])


def _bending_stiffness(length: Numbers, phi: Numbers) -> FloatArray:
    """Return the bending stiffness for E I = 1, (4, 4)."""
    force, couple = 12.0 + 0.0 * length, 6.0 * length
    near, far = (4.0 + phi) * length**2, (2.0 - phi) * length**2
    block: FloatArray = np.array(
        [
            [force, couple, -force, couple],
            [couple, near, -couple, far],
            [-force, -couple, force, -couple],
            [couple, far, -couple, near],
        ]
    ) / (length**3 * (1.0 + phi))
    return block


def _translational_mass(length: Numbers, phi: Numbers) -> FloatArray:
    """Return the mass of the deflection for rho A = 1, (4, 4)."""
    own = 13.0 / 35.0 + 7.0 / 10.0 * phi + phi**2 / 3.0
    other = 9.0 / 70.0 + 3.0 / 10.0 * phi + phi**2 / 6.0
    near = (11.0 / 210.0 + 11.0 / 120.0 * phi + phi**2 / 24.0) * length
    far = (13.0 / 420.0 + 3.0 / 40.0 * phi + phi**2 / 24.0) * length
    turn = (1.0 / 105.0 + phi / 60.0 + phi**2 / 120.0) * length**2
    cross = (1.0 / 140.0 + phi / 60.0 + phi**2 / 120.0) * length**2
    block: FloatArray = np.array(
        [
            [own, near, other, -far],
            [near, turn, far, -cross],
            [other, far, own, -near],
            [-far, -cross, -near, turn],
        ]
    ) * (length / (1.0 + phi) ** 2)
    return block


def _rotary_mass(length: Numbers, phi: Numbers) -> FloatArray:
    """Return the mass of the rotation for rho I = 1, (4, 4)."""
    slope = 6.0 / 5.0 + 0.0 * length
    couple = (1.0 / 10.0 - phi / 2.0) * length
    near = (2.0 / 15.0 + phi / 6.0 + phi**2 / 3.0) * length**2
    far = (-1.0 / 30.0 - phi / 6.0 + phi**2 / 6.0) * length**2
    block: FloatArray = _slopes(slope, couple, near, far) / (length * (1.0 + phi) ** 2)
    return block


def _slope_stiffness(length: Numbers, phi: Numbers) -> FloatArray:
    """Return the geometric stiffness for a tension of 1, (4, 4)."""
    slope = 6.0 / 5.0 + 2.0 * phi + phi**2
    couple = length / 10.0
    near = (2.0 / 15.0 + phi / 6.0 + phi**2 / 12.0) * length**2
    far = -(1.0 / 30.0 + phi / 6.0 + phi**2 / 12.0) * length**2
    block: FloatArray = _slopes(slope, couple, near, far) / (length * (1.0 + phi) ** 2)
    return block


def _slopes(slope: Numbers, couple: Numbers, near: Numbers, far: Numbers) -> FloatArray:
    block: FloatArray = np.array(
        [
            [slope, couple, -slope, couple],
            [couple, near, -couple, far],
            [-slope, -couple, slope, -couple],
            [couple, far, -couple, near],
        ]
    )
    return block


# The polynomials are written as products, so that they are exactly 0 or 1 at the nodes.


def _deflection(xi: float, length: Numbers, phi: Numbers) -> FloatArray:
    """Return the deflection at ``xi`` by the four bending dofs."""
    rest = 1.0 - xi
    block: FloatArray = np.array(
        [
            rest * (1.0 + xi - 2.0 * xi**2 + phi),
            length * xi * rest * (rest + phi / 2.0),
            xi * (3.0 * xi - 2.0 * xi**2 + phi),
            -length * xi * rest * (xi + phi / 2.0),
        ]
    ) / (1.0 + phi)
    return block


def _rotation(xi: float, length: Numbers, phi: Numbers) -> FloatArray:
    """Return the rotation of the section at ``xi`` by the four bending dofs."""
    rest = 1.0 - xi
    block: FloatArray = np.array(
        [
            -6.0 * xi * rest / length,
            rest * (1.0 - 3.0 * xi + phi),
            6.0 * xi * rest / length,
            xi * (3.0 * xi - 2.0 + phi),
        ]
    ) / (1.0 + phi)
    return block


def _turning(length: Numbers, phi_y: Numbers, phi_z: Numbers) -> FloatArray:
    """Return the mean along the beam of the rotation about y times that about z, (4, 4)."""
    means = []
    for xi, weight in _GAUSS_3:
        about_z = _rotation(xi, length, phi_y)
        about_y = -_beside(_SLOPE_SIGN, about_z) * _rotation(xi, length, phi_z)
        means.append(weight * about_y[:, np.newaxis] * about_z)
    mean: FloatArray = sum(means[1:], start=means[0])
    return mean


def _curvature(xi: float, length: Numbers, phi: Numbers) -> FloatArray:
    """Return the derivative of the rotation along the beam by the four bending dofs."""
    block: FloatArray = np.array(
        [
            6.0 * (2.0 * xi - 1.0) / length,
            6.0 * xi - 4.0 - phi,
            6.0 * (1.0 - 2.0 * xi) / length,
            6.0 * xi - 2.0 + phi,
        ]
    ) / (length * (1.0 + phi))
    return block
