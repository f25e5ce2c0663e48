"""One element of a beam with both ends held: what forces between its nodes do inside it.

Displacements of nodes under the work-equivalent forces of a load are those under the load itself,
but the forces and displacements that the nodes tell lack, inside the element, those of the load on
an element whose ends are held. For a force at one place they are its Green's functions.

J. S. Przemieniecki, Theory of Matrix Structural Analysis, 1968, chapter 10.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.elements.slice import Slice
from bumpstop.structure.elements.varying import flexibility, inertia, section_forces

__all__ = ["BeamElement", "gauss"]

POINTS = 10
"""Of Gauss's rule: exact for polynomials of degree 19, of which those of even sections have 9."""


@dataclass(frozen=True)
class BeamElement:
    """An element, in the local axes of its beam.

    Parameters
    ----------
    start, length
        Where along the beam it begins, and its length, in m.
    axes
        The local axes, one a row, (3, 3).
    slice_at
        What a slice resists and weighs, by how far along the element it is, from 0 to 1.
    interpolation
        The displacements and rotations there by the dofs of the nodes, (6, 12).
    is_lumped
        Whether its mass is that of its nodes.
    bends
        Whether it resists bending and twist.
    spin
        The speed in rad/s with which it turns about its axis.
    """

    start: float
    length: float
    axes: FloatArray
    slice_at: Callable[[float], Slice]
    interpolation: Callable[[float], FloatArray]
    is_lumped: bool
    bends: bool
    spin: float

    @property
    def end(self) -> float:
        """Where along the beam it ends, in m."""
        return self.start + self.length

    @cached_property
    def turn(self) -> FloatArray:
        """The matrix that turns forces and moments from global to local axes, (6, 6)."""
        return np.kron(np.eye(2), self.axes).astype(np.float64)

    def forces(self, at: float, place: float) -> FloatArray:
        """Return the forces in a section under a unit force or moment at a place, (6, 6).

        Rows are N, Vy, Vz, T, My and Mz of the section, columns the components of the force and
        the moment along the global axes; places in m along the beam.
        """
        return self._local_forces(at, place) @ self.turn

    def displacements(self, at: float, place: float) -> FloatArray:
        """Return displacements and rotations at a section under a unit force at a place, (6, 6).

        Rows and columns are along and about the global axes. By virtual forces: those of a unit
        force at the section on an element that is held at its first node.
        """
        found = np.zeros((6, 6))
        if not self.bends:  # what it resists, it resists along its axis
            return found
        between = sorted({self.start, min(at, place), at})
        for left, right in pairwise(between):
            for where, weight in gauss(left, right):
                part = self._slice(where)
                virtual = section_forces(part, at - where)
                own = flexibility(part)[:, np.newaxis] * self._local_forces(where, place)
                found += weight * virtual.T @ own
        in_global: FloatArray = self.turn.T @ found @ self.turn
        return in_global

    def motion(self, place: float) -> FloatArray:
        """Return displacements and rotations at a place by those of the nodes, (6, 12).

        All are along and about the global axes.
        """
        to_local = np.kron(np.eye(2), self.turn)
        in_global: FloatArray = self.turn.T @ self.interpolation(self._part(place)) @ to_local
        return in_global

    def inertia(self, place: float) -> FloatArray:
        """Return mass and rotary inertia a metre in global axes, (6, 6); none where lumped."""
        if self.is_lumped:
            return np.zeros((6, 6))
        own = inertia(self._slice(place))
        if not self.bends:
            own[3:] = 0.0
        in_global: FloatArray = self.turn.T @ (own[:, np.newaxis] * self.turn)
        return in_global

    def gyration(self, place: float) -> FloatArray:
        """Return the gyroscopic forces a metre by velocities, in global axes, (6, 6)."""
        moment = self.spin * inertia(self._slice(place))[3]
        own = np.zeros((6, 6))
        own[4, 5], own[5, 4] = moment, -moment
        in_global: FloatArray = self.turn.T @ own @ self.turn
        return in_global

    def _local_forces(self, at: float, place: float) -> FloatArray:
        """Return the forces in a section by those at a place along the local axes, (6, 6)."""
        part = self._slice(at)
        ends = self.interpolation(self._part(place))[:, 6:].T
        forces = -section_forces(part, self.end - at) @ ends
        if place > at:
            forces += section_forces(part, place - at)
        return forces

    def _slice(self, place: float) -> Slice:
        return self.slice_at(self._part(place))

    def _part(self, place: float) -> float:
        return min(max((place - self.start) / self.length, 0.0), 1.0)


def gauss(start: float, end: float) -> list[tuple[float, float]]:
    """Return places and weights by which an integral from start to end is a sum."""
    points, weights = _rule()
    half = 0.5 * (end - start)
    places = start + half * (1.0 + points)
    return list(zip(places.tolist(), (half * weights).tolist(), strict=True))


@lru_cache(maxsize=1)
def _rule() -> tuple[FloatArray, FloatArray]:
    """Return points and weights of Gauss's rule on [-1, 1]."""
    points, weights = np.polynomial.legendre.leggauss(POINTS)
    return points, weights
