"""Every force on a structure in a run, on all its dofs: loads, laws, damping, inertia."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.canonical import velocity_matrix
from bumpstop.errors import InputError
from bumpstop.laws.coordinate import coordinates_of
from bumpstop.loads.moving_force import MovingForce
from bumpstop.loads.support_motion import SupportMotion
from bumpstop.post.force_field import ForceField, Sizes, spread, sums
from bumpstop.post.moving import moving_fields
from bumpstop.post.turning_fields import turning_fields

if TYPE_CHECKING:
    from bumpstop.laws.coordinate import Coordinate
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Load
    from bumpstop.response import Response
    from bumpstop.structure.cut import Cut
    from bumpstop.structure.model import LinearModel
    from bumpstop.structure.sparse import SparseMatrix

__all__ = ["Forces"]


@dataclass(frozen=True, eq=False)
class Forces:
    """The forces of a run on all dofs of the model that its basis was made from.

    Raises
    ------
    InputError
        If the basis was not made from a structure.
    """

    response: Response

    def __post_init__(self) -> None:
        if not self.basis.has_masses:
            hint = "make the basis from a structure or from matrices"
            raise InputError("forces need the masses of a structure", key="basis", hint=hint)

    @property
    def basis(self) -> ModalBasis:
        """The modes."""
        return self.response.problem.basis

    @property
    def model(self) -> LinearModel:
        """What the modes were computed from."""
        model = self.basis.model
        assert model is not None  # it has masses
        return model

    @property
    def mass(self) -> SparseMatrix:
        """The masses of all dofs."""
        return self.basis.whole_mass

    @cached_property
    def local(self) -> tuple[ForceField, ...]:
        """The forces of loads, laws, dampers, gyroscopic and circulatory effects."""
        return (*self._loads(), *self._laws(), *self._velocity_forces())

    def inertia(self, times: FloatArray) -> FloatArray:
        """Return the inertia forces -M u'' at some times, (dofs, time)."""
        return -(self._mass_shapes @ self.response.motion(2, times).T)

    def inside(self, cut: Cut, times: FloatArray) -> FloatArray:
        """Return what all forces do at a place inside an element whose ends are held, (r, time).

        Inertia forces and modal damping are spread as masses are.
        """
        total = self._spread_inside(cut, times)
        for each in self.local:
            if each.inside is not None:
                total += each.inside(cut, times)
        return total

    def _spread_inside(self, cut: Cut, times: FloatArray) -> FloatArray:
        """Return what is spread as masses are does inside an element, (r, time)."""
        spreading = -self.response.motion(2, times).T
        spreading -= self._given_damping @ self.response.motion(1, times).T
        return cut.of_inertia(self.basis.shapes) @ spreading

    def modal_damping(self, times: FloatArray) -> FloatArray:
        """Return the forces of the damping that modes were given by ratios, (dofs, time).

        It has no place of its own and is spread over the structure as the modes' masses are.
        """
        return -(self._mass_shapes @ (self._given_damping @ self.response.motion(1, times).T))

    @cached_property
    def _given_damping(self) -> FloatArray:
        """What of the velocities' matrix no part of the structure has, (N, N)."""
        model, shapes = self.model, self.basis.shapes
        placed = shapes.T @ (model.damping @ shapes) + shapes.T @ (model.gyroscopic @ shapes)
        return velocity_matrix(self.basis) - placed

    @cached_property
    def untaken(self) -> tuple[ForceField, ...]:
        """What of the local forces the modes do not take, and what of the elastic ones.

        Inertia and elastic forces of the modes balance M Phi Phi' f of a force f. A vector of
        the basis that is no mode of the structure, such as a static shape, leaves K phi - w2 M phi.
        """
        basis, shapes, mass = self.basis, self.basis.shapes, self._mass_shapes
        left = [
            field._replace(fields=field.fields - mass @ (shapes.T @ field.fields))
            for field in self.local
        ]
        elastic = mass * basis.omega2 - self.model.stiffness @ shapes
        return (*left, ForceField("elastic", elastic, lambda times: self.response.motion(0, times)))

    @cached_property
    def _mass_shapes(self) -> FloatArray:
        """The forces on all dofs that push one coordinate each, by one, (dofs, N)."""
        return self.mass @ self.basis.shapes

    def _loads(self) -> Iterator[ForceField]:
        for load in self.response.problem.loads:
            yield from self._load(load)

    def _load(self, load: Load) -> Iterator[ForceField]:
        """Yield the forces of a load."""
        duration = self.response.problem.duration
        if isinstance(load, SupportMotion):
            yield self._support_forces(load)
            return
        if isinstance(load, MovingForce):
            yield from moving_fields(load, self.basis, self._mass_shapes, duration)
            return
        components = load.components(self.basis)
        fields = getattr(load, "nodal_forces", None)
        if fields is None:
            what = "says nothing of its forces on the nodes"
            raise InputError(what, key=f"loads.{load.name}")
        sizes = sums([functions for _, functions in components], duration)
        inside = getattr(load, "inside", None)
        own = None if inside is None else spread(inside, sizes)
        yield ForceField("load", fields(self.model), sizes, own)

    def _support_forces(self, load: SupportMotion) -> ForceField:
        """Return the forces on what moves against supports that carry it along, by its inertia."""
        model, field = self.model, load.field(self.model)
        rates = [
            -(model.circulatory @ field),
            -(model.damping @ field + model.gyroscopic @ field),
            -(self.mass @ field),
        ]
        travel = load.travel(self.response.problem.duration)

        def sizes(times: FloatArray) -> FloatArray:
            return np.stack([travel.at(times, order) for order in range(3)], axis=1)

        return ForceField("load", np.stack(rates, axis=1), sizes, spread(load.inside, sizes))

    def carried(self, times: FloatArray) -> FloatArray:
        """Return the displacements by which supports that move differently carry all dofs along.

        They bend the structure, (dofs, time); zero where none do.
        """
        problem = self.response.problem
        total = np.zeros((len(self.model.dofs), len(times)))
        for load in problem.loads:
            if isinstance(load, SupportMotion):
                moved = load.travel(problem.duration).at(times, 0)
                total += np.outer(load.field(self.model), moved)
        return total

    def _laws(self) -> Iterator[ForceField]:
        for number, law in enumerate(self.response.problem.laws):
            along = coordinates_of(law, self.basis)
            fields = np.stack([each.nodal_force(self.model) for each in along], axis=1)
            sizes = self._law_forces(number)
            yield ForceField("law", fields, sizes, spread(partial(_inside, along), sizes))

    def _law_forces(self, number: int) -> Sizes:
        return lambda times: self.response.history.law_forces(number, times)

    def _velocity_forces(self) -> Iterator[ForceField]:
        model, shapes = self.model, self.basis.shapes
        rotation = self.response.problem.rotation
        damped = -(model.damping @ shapes)
        if damped.any():
            yield ForceField("damping", damped, partial(self.response.motion, 1))
        gyroscopic = -(model.gyroscopic @ shapes)
        if gyroscopic.any():
            # Dampers are at nodes, gyroscopic moments along beams.
            yield from turning_fields(self.response, gyroscopic, rotation)
        turned = -(model.circulatory @ shapes)
        if turned.any():
            yield ForceField("damping", turned, lambda times: self.response.motion(0, times))


def _inside(along: Sequence[Coordinate], cut: Cut) -> FloatArray:
    """Return what unit forces along some coordinates do inside an element, (r, m)."""
    return np.stack([each.inside(cut) for each in along], axis=1)
