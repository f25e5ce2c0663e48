"""Every force on a structure in a run, on all its dofs: loads, laws, damping, inertia."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.canonical import velocity_matrix
from bumpstop.errors import InputError
from bumpstop.loads.support_motion import SupportMotion

if TYPE_CHECKING:
    from bumpstop.loads.time import TimeFunction
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Law
    from bumpstop.response import Response
    from bumpstop.structure.model import LinearModel

__all__ = ["ForceField", "Forces"]


class ForceField(NamedTuple):
    """Forces of one kind: fields of all dofs times functions of time."""

    kind: str
    """``load``, ``law``, ``damping`` (gyroscopic and circulatory forces too) or ``elastic``."""
    fields: FloatArray
    """In N and N m where the functions are one, (dofs, m)."""
    sizes: Callable[[FloatArray], FloatArray]
    """The functions, (time, m), at some times in s."""


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
        self.basis.require_modes("basis")
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

    @cached_property
    def local(self) -> tuple[ForceField, ...]:
        """The forces of loads, laws, dampers, gyroscopic and circulatory effects."""
        return (*self._loads(), *self._laws(), *self._velocity_forces())

    def inertia(self, times: FloatArray) -> FloatArray:
        """Return the inertia forces -M u'' at some times, (dofs, time)."""
        return -(self._mass_shapes @ self.response.motion(2, times).T)

    def modal_damping(self, times: FloatArray) -> FloatArray:
        """Return the forces of the damping that modes were given by ratios, (dofs, time).

        It has no place of its own and is spread over the structure as the modes' masses are.
        """
        model, shapes = self.model, self.basis.shapes
        placed = shapes.T @ (model.damping @ shapes) + shapes.T @ (model.gyroscopic @ shapes)
        given = velocity_matrix(self.basis) - placed
        return -(self._mass_shapes @ (given @ self.response.motion(1, times).T))

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
        return self.model.mass @ self.basis.shapes

    def _loads(self) -> Iterator[ForceField]:
        duration = self.response.problem.duration
        for load in self.response.problem.loads:
            if isinstance(load, SupportMotion):
                yield self._support_forces(load)
                continue
            components = load.components(self.basis)
            fields = getattr(load, "nodal_forces", None)
            if fields is None:
                what = "says nothing of its forces on the nodes"
                raise InputError(what, key=f"loads.{load.name}")
            functions = [each for _, each in components]
            yield ForceField("load", fields(self.model), _sums(functions, duration))

    def _support_forces(self, load: SupportMotion) -> ForceField:
        """Return the forces on what moves against supports that carry it along, by its inertia."""
        model, field = self.model, load.field(self.model)
        rates = [
            -(model.circulatory @ field),
            -(model.damping @ field + model.gyroscopic @ field),
            -(model.mass @ field),
        ]
        travel = load.travel(self.response.problem.duration)

        def sizes(times: FloatArray) -> FloatArray:
            return np.stack([travel.at(times, order) for order in range(3)], axis=1)

        return ForceField("load", np.stack(rates, axis=1), sizes)

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
            fields = np.stack(list(self._along(law)), axis=1)
            yield ForceField("law", fields, self._law_forces(number))

    def _along(self, law: Law) -> Iterator[FloatArray]:
        """Yield unit forces along the coordinates of a law, in the order of the core's."""
        several = getattr(law, "coordinates", None)
        if several is not None:
            yield from (each.nodal_force(self.model) for each in several)
            return
        yield law.coordinate.nodal_force(self.model)
        if getattr(law, "friction", None) is not None:
            from bumpstop.laws.friction import sliding_coordinate

            sliding = getattr(law, "sliding", None)
            yield sliding_coordinate(self.basis, law.coordinate, sliding).nodal_force(self.model)

    def _law_forces(self, number: int) -> Callable[[FloatArray], FloatArray]:
        return lambda times: self.response.history.law_forces(number, times)

    def _velocity_forces(self) -> Iterator[ForceField]:
        model, shapes = self.model, self.basis.shapes
        moved = -(model.damping @ shapes) - (model.gyroscopic @ shapes)
        if moved.any():
            yield ForceField("damping", moved, lambda times: self.response.motion(1, times))
        turned = -(model.circulatory @ shapes)
        if turned.any():
            yield ForceField("damping", turned, lambda times: self.response.motion(0, times))


def _sums(
    functions: Sequence[Sequence[TimeFunction]], duration: float
) -> Callable[[FloatArray], FloatArray]:
    """Return the sums of some functions of time; of none, the constant one."""
    from bumpstop.loads.time import resolved

    terms = [resolved(each, duration) if each else None for each in functions]

    def sizes(times: FloatArray) -> FloatArray:
        ones = np.ones(len(times))
        columns = [
            ones if each is None else sum((term.at(times) for term in each), 0.0 * ones)
            for each in terms
        ]
        return np.stack(columns, axis=1)

    return sizes
