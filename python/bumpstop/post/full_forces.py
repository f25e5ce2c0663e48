"""FullForces: every force on a structure in a run of a full model, on all its dofs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.errors import InputError
from bumpstop.loads.inertia import InertialLoad
from bumpstop.loads.support_motion import SupportMotion
from bumpstop.modal.full import FullModel, numbers_of
from bumpstop.post.force_field import ForceField, sums
from bumpstop.post.forces import Forces
from bumpstop.structure.sparse import SparseMatrix

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.problem import Load
    from bumpstop.structure.cut import Cut

__all__ = ["FullForces"]


@dataclass(frozen=True, eq=False)
class FullForces(Forces):
    """The forces of a run of a full model: nothing is left out, and nothing to be corrected.

    Accelerations are those of the step method.

    Raises
    ------
    InputError
        If the run has not kept the motion of all dofs.
    """

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.response.kept is not None:
            what = "needs the motion of all dofs, of which the run has kept a few"
            hint = "run a shorter time, or with longer steps"
            raise InputError(what, key="response", hint=hint)

    @property
    def full(self) -> FullModel:
        """The structure on its own dofs."""
        basis = self.basis
        assert isinstance(basis, FullModel)  # by its caller
        return basis

    def inertia(self, times: FloatArray) -> FloatArray:
        """Return the inertia forces -M u'' at some times, (dofs, time)."""
        return -(self.mass @ self._moved(2, times))

    def modal_damping(self, times: FloatArray) -> FloatArray:
        """Return the forces of the damping that no part of the structure has, (dofs, time).

        It has no place of its own, and acts on the independent dofs.
        """
        damping = self.full.matrices.damping
        own = damping.plus(self.model.reduced(self.model.damping).scaled(-1.0))
        found = np.zeros((len(self.model.dofs), len(times)))
        found[self.model.free] = -(own @ self.response.motion(1, times).T)
        return found

    @property
    def untaken(self) -> tuple[ForceField, ...]:
        """Nothing: the dofs take all forces."""
        return ()

    def _load(self, load: Load) -> Iterator[ForceField]:
        """Yield the forces of a load; what pulls at lumped masses pulls at the nodes alone."""
        if self.full.lumped and isinstance(load, InertialLoad):
            weight = self.mass @ load.pull(self.model)
            sizes = sums([load.functions], self.response.problem.duration)
            yield ForceField("load", weight[:, np.newaxis], sizes)
        elif self.full.lumped and isinstance(load, SupportMotion):
            yield self._support_forces(load)._replace(inside=None)
        else:
            yield from super()._load(load)

    def _spread_inside(self, cut: Cut, times: FloatArray) -> FloatArray:
        """Return what inertia does inside an element, (r, time); none where lumped."""
        if self.full.lumped:
            return np.zeros((len(cut.kernel(cut.at)), len(times)))
        return -(cut.of_inertia(self.basis.shapes) @ self.response.motion(2, times).T)

    @cached_property
    def _mass_shapes(self) -> FloatArray:
        """The forces on all dofs that push one coordinate each, by one, (dofs, N)."""
        return numbers_of(SparseMatrix.selection(len(self.model.dofs), self.model.free))

    def _velocity_forces(self) -> Iterator[ForceField]:
        """Yield the forces of dampers, by the dofs that they are at."""
        damping = self.model.damping
        dofs = np.unique(damping.columns[damping.values != 0.0])
        if dofs.size:
            rows, columns = damping.dense_columns(dofs)
            fields = np.zeros((len(self.model.dofs), len(dofs)))
            fields[rows] = -columns
            yield ForceField("damping", fields, lambda times: self._moved(1, times)[dofs].T)

    def _moved(self, derivative: int, times: FloatArray) -> FloatArray:
        """Return displacements (0), velocities or accelerations of all dofs, (dofs, time)."""
        return self.basis.shapes @ self.response.motion(derivative, times).T
