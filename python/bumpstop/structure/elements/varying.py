"""The two-node beam element of varying section, or with its shear centre off the centroid.

The element is loaded at its ends only, so that the forces in every section are known. Its
flexibility as a cantilever is the integral of b' f b, where b takes the forces at the second
node to those in a section and f is the flexibility of the section; the inverse is the
stiffness. The displacements in between follow from virtual forces. Both are integrated by
Gauss's rule; the stiffness is exact for end loads up to the error of that rule, which for a
section that doubles along the element is about 1e-11.

J. S. Przemieniecki, Theory of Matrix Structural Analysis, 1968, chapter 7; A. Neuenhofer and
F. C. Filippou, Journal of Structural Engineering 123 (1997) 958-966.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import lru_cache

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.elements.slice import Slice
from bumpstop.structure.frame import rigid_motions

__all__ = ["VaryingElement", "flexibility", "inertia", "section_forces"]

_POINTS = 10
"""Points of Gauss's rule: exact for polynomials of degree 19."""


class VaryingElement:
    """One element, in its local axes from the first node to the second.

    Parameters
    ----------
    length
        Length in m.
    slice_at
        What a slice resists and weighs, by how far along it is, from 0 to 1.
    """

    def __init__(self, length: float, slice_at: Callable[[float], Slice]) -> None:
        self._length = length
        self._slice_at = slice_at
        self._difference = np.hstack([-_carried(length), np.eye(6)])
        flexibility = self._bent(1.0)
        self._end_forces = np.linalg.solve(flexibility, self._difference)

    def stiffness(self) -> FloatArray:
        """Return the stiffness matrix (12, 12), in N/m, N and N m."""
        return _symmetric(self._difference.T @ self._end_forces)

    def mass(self) -> FloatArray:
        """Return the consistent mass matrix (12, 12), in kg, kg m and kg m2."""
        matrix = np.zeros((12, 12))
        for xi, weight in self._points():
            functions = self.interpolation(xi)
            matrix += weight * functions.T @ (inertia(self._slice_at(xi))[:, None] * functions)
        return _symmetric(matrix)

    def lumped_mass(self) -> FloatArray:
        """Return the diagonal mass matrix (12, 12): what is nearer to it goes to each node.

        Sections without rotary inertia turn as those of the element of constant section do.
        """
        matrix = np.zeros((12, 12))
        for end in (0, 1):
            node = np.zeros(6)
            for xi, weight in self._points(0.5):
                node += weight * inertia(self._slice_at(xi + 0.5 * end))
            without = node[0] * self._length**2 / 39.0
            node[4:] = np.where(node[4:] == 0.0, without, node[4:])
            place = np.arange(6) + 6 * end
            matrix[place, place] = node
        return matrix

    def geometric_stiffness(self, tension: float) -> FloatArray:
        """Return what an axial force, positive in tension, adds to the stiffness, (12, 12)."""
        matrix = np.zeros((12, 12))
        for xi, weight in self._points():
            part = self._slice_at(xi)
            functions, strains = self.interpolation(xi), self._strains(xi)
            slope_y = functions[5] + strains[1] + part.center_z * strains[3]
            slope_z = -functions[4] + strains[2] - part.center_y * strains[3]
            polar = (part.inertia_y + part.inertia_z) / part.area
            for row, factor in ((slope_y, 1.0), (slope_z, 1.0), (strains[3], polar)):
                matrix += weight * tension * factor * np.outer(row, row)
        return _symmetric(matrix)

    def gyroscopic(self, spin: float) -> FloatArray:
        """Return the skew-symmetric gyroscopic matrix (12, 12) of a spin about local x."""
        matrix = np.zeros((12, 12))
        for xi, weight in self._points():
            functions = self.interpolation(xi)
            momentum = spin * inertia(self._slice_at(xi))[3]
            matrix += weight * momentum * np.outer(functions[4], functions[5])
        return matrix - matrix.T

    def interpolation(self, xi: float) -> FloatArray:
        """Return displacements and rotations at ``xi`` in [0, 1] by the dofs, (6, 12)."""
        functions = self._bent(xi) @ self._end_forces
        functions[:, :6] += _carried(xi * self._length)
        return functions

    def axial_strain(self, xi: float, fibre: tuple[float, float]) -> FloatArray:
        """Return the axial strain of a fibre (y, z) at ``xi`` by the dofs, (12,), in 1/m."""
        strains = self._strains(xi)
        strain: FloatArray = strains[0] - fibre[0] * strains[5] + fibre[1] * strains[4]
        return strain

    def section_forces(self, xi: float) -> FloatArray:
        """Return the forces in the section at ``xi`` by the dofs, (6, 12).

        N, Vy, Vz, the torque about the shear centre, My and Mz: what the part beyond the section
        does to the part before it.
        """
        forces = section_forces(self._slice_at(xi), (1.0 - xi) * self._length)
        by_dofs: FloatArray = forces @ self._end_forces
        return by_dofs

    def _strains(self, xi: float) -> FloatArray:
        """Return stretch, two shears, twist and two curvatures at ``xi`` by the dofs, (6, 12)."""
        part = self._slice_at(xi)
        strains: FloatArray = flexibility(part)[:, np.newaxis] * self.section_forces(xi)
        return strains

    def _bent(self, xi: float) -> FloatArray:
        """Return how forces at the second node bend the element up to ``xi``, (6, 6).

        It is clamped at the first node; rows are displacements and rotations at ``xi``.
        """
        motion = np.zeros((6, 6))
        for place, weight in self._points(xi):
            part = self._slice_at(place)
            virtual = section_forces(part, (xi - place) * self._length)
            forces = section_forces(part, (1.0 - place) * self._length)
            motion += weight * virtual.T @ (flexibility(part)[:, np.newaxis] * forces)
        return motion

    def _points(self, up_to: float = 1.0) -> Iterator[tuple[float, float]]:
        """Yield places from 0 to 1, and weights in m, that integrate from the first node on."""
        for point, weight in _rule():
            yield point * up_to, weight * up_to * self._length


@lru_cache(maxsize=1)
def _rule() -> tuple[tuple[float, float], ...]:
    """Return points and weights of Gauss's rule on [0, 1]."""
    points, weights = np.polynomial.legendre.leggauss(_POINTS)
    return tuple(zip((0.5 + 0.5 * points).tolist(), (0.5 * weights).tolist(), strict=True))


def _carried(distance: float) -> FloatArray:
    """Return the rigid motion at a distance along x by that of the first node, (6, 6)."""
    return rigid_motions(np.array([[distance, 0.0, 0.0]]), np.zeros(3))


def section_forces(part: Slice, distance: float) -> FloatArray:
    """Return the forces in a section by those at a distance beyond it, (6, 6).

    Forces and moments on the centroid beyond make a normal force, two shear forces, a torque
    about the shear centre and two bending moments.
    """
    forces = np.eye(6)
    forces[3, 1], forces[3, 2] = part.center_z, -part.center_y
    forces[4, 2], forces[5, 1] = -distance, distance
    return forces


def flexibility(part: Slice) -> FloatArray:
    """Return stretch, shears, twist and curvatures by unit forces, (6,)."""
    shear = part.shear * part.area
    return 1.0 / np.array(
        [
            part.young * part.area,
            part.factor_y * shear,
            part.factor_z * shear,
            part.shear * part.torsion_constant,
            part.young * part.inertia_y,
            part.young * part.inertia_z,
        ]
    )


def inertia(part: Slice) -> FloatArray:
    """Return mass and rotary inertia a metre, along and about the local axes, (6,)."""
    polar = part.inertia_y + part.inertia_z
    return part.density * np.array([part.mass_area] * 3 + [polar, part.rotary_y, part.rotary_z])


def _symmetric(matrix: FloatArray) -> FloatArray:
    return 0.5 * (matrix + matrix.T)
