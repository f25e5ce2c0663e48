"""The motion of a component that follows its interface, statically and rigidly."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.modal.independent import independent_vectors, without
from bumpstop.modal.solve import StaticSolver
from bumpstop.modal.substructure.clamped import ClampedModel
from bumpstop.modal.substructure.component import Component
from bumpstop.structure.echelon import independent_rows, null_space
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["InterfaceStatics"]


class InterfaceStatics:
    """What the interface of a component does to its inside, by the independent dofs.

    Rigid motions of two kinds are told apart: those that leave the interface where it is
    (there are none if the interface can hold the component) and those that it takes part in.

    Parameters
    ----------
    component
        The component.
    """

    def __init__(self, component: Component) -> None:
        self._model = component.model
        self._boundary = component.boundary_coordinates
        self.clamped = ClampedModel(component.model, self._boundary)

    @cached_property
    def loose(self) -> FloatArray:
        """Rigid motions that leave the interface still, of unit mass, (free dofs, motions)."""
        rigid = self._rigid
        loose = rigid @ null_space(rigid[self._boundary])
        return independent_vectors(loose, self._mass).vectors

    @cached_property
    def leading(self) -> FloatArray:
        """Rigid motions that the interface takes part in, (free dofs, motions).

        Each moves one of the ``led`` dofs of the interface by one and leaves the others still;
        none has a momentum in common with the loose ones.
        """
        led = self._rigid[self._boundary][self._led]
        columns = independent_rows(led.T)
        leading: FloatArray = self._rigid[:, columns] @ np.linalg.inv(led[:, columns])
        return without(self.loose, leading, self._mass)

    @cached_property
    def constraint_modes(self) -> FloatArray:
        """Static shape for each dof of the interface moved by one, (free dofs, interface dofs).

        The others are still. Their combinations hold the leading rigid motions to rounding of
        the last bits, however stiff the component.
        """
        inside, boundary = self.clamped.moving, self._boundary
        shapes = np.zeros((len(self._model.free), len(boundary)))
        shapes[boundary, np.arange(len(boundary))] = 1.0
        shapes[inside] = -self._solver.solve((self._stiffness @ shapes)[inside])
        # A static solution is off by rounding times the condition of the matrix, which moves
        # the frequencies of rigid motions away from zero: what these lack is known and added.
        lacking = self.leading - shapes @ self.leading[boundary]
        shapes[inside[:, np.newaxis], self._led] += lacking[inside]
        return shapes

    @cached_property
    def relief_modes(self) -> FloatArray:
        """Static shapes under the inertia forces of the leading motions, interface still."""
        inside = self.clamped.moving
        shapes = np.zeros(self.leading.shape)
        shapes[inside] = self._solver.solve((self._mass @ self.leading)[inside])
        return shapes

    @cached_property
    def _rigid(self) -> FloatArray:
        return self._model.rigid_shapes()

    @cached_property
    def _led(self) -> list[int]:
        """Dofs of the interface that tell the motion of all, if it is a rigid one."""
        return independent_rows(self._rigid[self._boundary])

    @cached_property
    def _stiffness(self) -> SparseMatrix:
        return self._model.reduced(self._model.stiffness)

    @cached_property
    def _mass(self) -> SparseMatrix:
        return self._model.reduced(self._model.mass)

    @cached_property
    def _solver(self) -> StaticSolver:
        inside = self.clamped.moving
        return StaticSolver(self._stiffness.restricted(inside), self.loose[inside])
