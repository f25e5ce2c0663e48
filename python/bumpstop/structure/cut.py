"""Cut: what is read at a place of a beam, and what the forces on its element do there."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.beam_element import BeamElement, gauss
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.model import LinearModel
from bumpstop.structure.points import beam_point
from bumpstop.structure.smooth_pieces import SmoothPieces

__all__ = ["Cut"]

Density = Callable[[float], FloatArray]
"""Forces and moments a metre along the global axes at a place, one a column, (6, m)."""


@dataclass(frozen=True)
class Cut:
    """Some numbers at a place of a beam, such as the forces in a section.

    Parameters
    ----------
    model
        The model that the beam belongs to.
    beam
        Its name.
    at
        The place, in m from the first node.
    element
        The element that the place is in.
    kernel
        What a unit force or moment along the global axes, at another place of the element, adds
        to the numbers while both of its ends are held, (r, 6).
    """

    model: LinearModel
    beam: str
    at: float
    element: BeamElement
    kernel: Callable[[float], FloatArray]

    def of_point(self, node: str, weights: Mapping[str, float]) -> FloatArray:
        """Return what a force at a node or point does, its components by the dofs, (r,)."""
        point = beam_point(node)
        place = self.at if point is None else point[1]
        force = np.array([weights.get(dof, 0.0) for dof in DOFS])
        found: FloatArray = self.kernel(place) @ force
        is_inside = self.element.start <= place < self.element.end
        # What acts at a node does nothing in an element whose ends are held.
        inside = point is not None and point[0] == self.beam and is_inside
        return found if inside else np.zeros_like(found)

    def of_places(self, beam: str, places: FloatArray, force: FloatArray) -> FloatArray:
        """Return what a force (6,) does, at one place of a beam after the other, (r, n)."""
        found = np.zeros((len(self.kernel(self.at)), len(places)))
        first, last = self.element.start, self.element.end
        inside = (places >= first) & (places <= last)
        if beam == self.beam and inside.any():
            edges = sorted({first, min(max(self.at, first), last), last})
            pieces = SmoothPieces(lambda place: self.kernel(place) @ force, edges)
            found[:, inside] = pieces.at(places[inside]).T
        return found

    def of_density(self, density: Density, start: float, end: float) -> FloatArray:
        """Return what forces a metre do between two places of the beam, (r, m)."""
        first, last = max(start, self.element.start), min(end, self.element.end)
        edges = sorted({first, min(max(self.at, first), last), last})
        found = 0.0 * (self.kernel(self.at) @ density(self.at))
        if first >= last:
            return found
        for left, right in pairwise(edges):
            for place, weight in gauss(left, right):
                found += weight * (self.kernel(place) @ density(place))
        return found

    def of_inertia(self, fields: FloatArray) -> FloatArray:
        """Return what the element's masses times accelerations of all dofs do, (r, m)."""
        return self._of_field(self.element.inertia, fields)

    def of_gyration(self, fields: FloatArray) -> FloatArray:
        """Return what gyroscopic forces do under velocities of all dofs, (r, m)."""
        if self.element.spin == 0.0:
            return np.zeros((len(self.kernel(self.at)), fields.shape[1]))
        return self._of_field(self.element.gyration, fields)

    def _ends(self, fields: FloatArray) -> FloatArray:
        """Return displacements and rotations of the element's nodes, (12, m)."""
        nodes = [f"{self.beam}@{place!r}" for place in (self.element.start, self.element.end)]
        forms = [self.model.displacement_form(node, dof) for node in nodes for dof in DOFS]
        return np.stack([form.of(fields) for form in forms])

    def _of_field(self, matrix: Callable[[float], FloatArray], fields: FloatArray) -> FloatArray:
        ends = self._ends(fields)

        def density(place: float) -> FloatArray:
            found: FloatArray = matrix(place) @ self.element.motion(place) @ ends
            return found

        return self.of_density(density, self.element.start, self.element.end)
