"""A component reduced to the dofs of its interface and a few shapes more."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.modal.substructure.component import Component
from bumpstop.modal.substructure.interface import InterfaceStatics

__all__ = ["ReducedComponent", "reduced_component"]


@dataclass(frozen=True, eq=False)
class ReducedComponent:
    """A component whose motion is that of its interface and of shapes that leave it still.

    Its displacement is ``shapes @ y``. The first of the coordinates y are the dofs of the
    interface, in m and rad; the others, amplitudes of the inner shapes, in m kg^0.5.

    Make one with ``craig_bampton`` or ``free_interface``.

    Parameters
    ----------
    component
        What was reduced.
    shapes
        Displacement of all dofs for each coordinate, (dofs, coordinates): the recovery matrix.
    labels
        What each of the inner shapes is: ``"mode 1"``, ...
    rigid
        Coordinates of the motions that strain nothing, (coordinates, motions), exact.
    """

    component: Component
    shapes: FloatArray = field(repr=False)
    labels: tuple[str, ...]
    rigid: FloatArray = field(repr=False)

    @cached_property
    def stiffness(self) -> FloatArray:
        """Stiffness matrix of the coordinates."""
        return self._reduced("stiffness")

    @cached_property
    def mass(self) -> FloatArray:
        """Mass matrix of the coordinates."""
        return self._reduced("mass")

    @cached_property
    def damping(self) -> FloatArray:
        """Damping matrix of the coordinates."""
        return self._reduced("damping")

    @cached_property
    def gyroscopic(self) -> FloatArray:
        """Gyroscopic matrix of the coordinates, skew-symmetric."""
        return self._reduced("gyroscopic")

    @cached_property
    def circulatory(self) -> FloatArray:
        """Circulatory matrix of the coordinates, skew-symmetric."""
        return self._reduced("circulatory")

    def _reduced(self, matrix: str) -> FloatArray:
        reduced = self.shapes.T @ (getattr(self.component.model, matrix) @ self.shapes)
        sign = -1.0 if matrix in ("gyroscopic", "circulatory") else 1.0
        exact: FloatArray = 0.5 * (reduced + sign * reduced.T)
        return exact


def reduced_component(
    component: Component, statics: InterfaceStatics, inner: FloatArray, labels: Sequence[str]
) -> ReducedComponent:
    """Return a component reduced to its constraint modes and inner shapes (dofs, count).

    Rigid motions that the interface cannot hold are inner shapes on top.
    """
    expansion = component.model.expansion
    loose, leading = statics.loose, statics.leading[component.boundary_coordinates]
    shapes = np.hstack([expansion @ statics.constraint_modes, expansion @ loose, inner])
    # Nothing but its own constraint mode moves a dof of the interface.
    boundary = len(component.boundary)
    shapes[component.boundary] = np.eye(boundary, shapes.shape[1])
    rigid = np.zeros((shapes.shape[1], leading.shape[1] + loose.shape[1]))
    rigid[:boundary, : leading.shape[1]] = leading
    rigid[boundary : boundary + loose.shape[1], leading.shape[1] :] = np.eye(loose.shape[1])
    turning = [f"rigid {number}" for number in range(1, loose.shape[1] + 1)]
    return ReducedComponent(component, shapes, (*turning, *labels), rigid)
