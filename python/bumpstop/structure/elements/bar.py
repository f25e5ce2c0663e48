"""The two-node bar: it resists stretching only, and carries its mass in every direction.

Displacements are linear between the nodes. The nodes' rotations take no part. Arguments are
those of the prismatic element. A tight bar is a string: its tension resists sideways motion.

J. S. Przemieniecki, Theory of Matrix Structural Analysis, 1968, chapters 5, 11 and 15.
"""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.elements.prismatic import Numbers
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


def stiffness(length: Numbers, part: Slice) -> FloatArray:
    """Return the local stiffness matrix (12, 12), in N/m."""
    spring = part.young * part.area / length
    return _along([0], spring, -spring)


def mass(length: Numbers, part: Slice) -> FloatArray:
    """Return the local consistent mass matrix (12, 12), in kg."""
    sixth = part.density * part.mass_area * length / 6.0
    return _along([0, 1, 2], 2.0 * sixth, sixth)


def lumped_mass(length: Numbers, part: Slice) -> FloatArray:
    """Return the local diagonal mass matrix (12, 12), in kg: half of the bar at each node."""
    half = 0.5 * part.density * part.mass_area * length
    return _along([0, 1, 2], half, 0.0 * half)


def geometric_stiffness(length: Numbers, _part: Slice, tension: Numbers) -> FloatArray:
    """Return what an axial force, positive in tension, adds to the stiffness, (12, 12)."""
    pull = tension / length
    return _along([1, 2], pull, -pull)


def gyroscopic(length: Numbers, _part: Slice, _spin: Numbers) -> FloatArray:
    """Return zeros (12, 12): a bar has no rotary inertia."""
    return np.zeros((*np.shape(length), 12, 12))


def interpolation(xi: float, length: float, _part: Slice) -> FloatArray:
    """Return displacements at ``xi`` in [0, 1] by the local dofs, and the slopes, (6, 12)."""
    functions = np.zeros((6, 12))
    for axis in range(3):
        functions[axis, [axis, axis + 6]] = 1.0 - xi, xi
    functions[5, [1, 7]] = -1.0 / length, 1.0 / length
    functions[4, [2, 8]] = 1.0 / length, -1.0 / length
    return functions


def axial_strain(
    _xi: float, _fibre: tuple[float, float], length: float, _part: Slice
) -> FloatArray:
    """Return the axial strain by the local dofs, (12,), in 1/m; it is the same everywhere."""
    strain = np.zeros(12)
    strain[[0, 6]] = -1.0 / length, 1.0 / length
    return strain


def _along(axes: list[int], own: Numbers, other: Numbers) -> FloatArray:
    """Return a matrix (12, 12) that couples each of these displacements of the two nodes."""
    matrix = np.zeros((*np.shape(own), 12, 12))
    for axis in axes:
        matrix[..., axis, axis] = matrix[..., axis + 6, axis + 6] = own
        matrix[..., axis, axis + 6] = matrix[..., axis + 6, axis] = other
    return matrix
