"""VelocityField: the undeformed structure moves at t = 0 with a velocity for each of its dofs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from bumpstop.arguments import FloatArray, Vector
from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.model import LinearModel

__all__ = ["VelocityField"]

_ROUNDING = 1e-9
"""A velocity this small beside the largest of its kind is rounding."""

_TOLD = 0.01
"""The share of the kinetic energy beyond the basis from which a user is told."""


class VelocityField(ABC):
    """A velocity field, projected on the modes with the mass matrix.

    Where a support holds a mass, the field must leave it at rest: a structure cannot start
    against its supports. What the modes of the basis cannot follow of the rest is lost, as
    motion that changes quickly in space always is; of more than a hundredth of the kinetic
    energy, `remarks` says so.
    """

    motion: ClassVar[str]
    """What the field is, in a word."""
    key: ClassVar[str]
    """The argument that says how fast."""
    hint: ClassVar[str]
    """How to leave at rest what is held."""

    @abstractmethod
    def field(self, model: LinearModel) -> FloatArray:
        """Return the velocity of each dof, in m/s and rad/s, (dofs,)."""

    def modal_state(self, basis: ModalBasis) -> tuple[FloatArray, FloatArray]:
        """Return modal displacement, which is zero, and velocity, each (N,).

        Raises
        ------
        InputError
            If the basis was not made from a structure, the structure has not what the field
            names, something that is held would move, or no mode takes part.
        """
        model = self._model(basis)
        field = self.field(model)
        self._refuse_held(model, field)
        velocity = basis.project_field(field)
        if field.any() and not velocity.any():
            what = f"no mode takes part in this {self.motion}"
            raise InputError(what, key=self.key, value=self._fastness)
        return np.zeros(len(velocity)), velocity

    def remarks(self, basis: ModalBasis) -> tuple[str, ...]:
        """Return a line that tells how much of the kinetic energy is lost, if that is much."""
        model = self._model(basis)
        field = self.field(model)
        given = _twice_energy(model, field)
        velocity = basis.project_field(field)
        lost = given - velocity @ velocity
        if not lost > _TOLD * given:
            return ()
        share = f"{100.0 * lost / given:.3g} %"
        more = "more modes hold more of it"
        return (
            f"{share} of the kinetic energy of the initial {self.motion} is lost: "
            f"the basis cannot follow it; {more}",
        )

    @property
    def _fastness(self) -> Vector:
        given: Vector = getattr(self, self.key)
        return given

    def _model(self, basis: ModalBasis) -> LinearModel:
        if basis.model is None:
            what = "needs a basis computed from a structure"
            hint = "give a ModalState, or make the basis from a structure"
            raise InputError(what, key=self.key, value=self._fastness, hint=hint)
        return basis.model

    def _refuse_held(self, model: LinearModel, field: FloatArray) -> None:
        """Raise where a dof that has inertia, but cannot move, is asked to."""
        at_rest = np.ones(len(field), dtype=bool)
        at_rest[model.expansion.rows] = False
        heavy = np.zeros(len(field), dtype=bool)
        heavy[model.mass.rows] = True
        for kind, unit in ((DOFS[:3], "m/s"), (DOFS[3:], "rad/s")):
            speeds = np.where([dof in kind for _, dof in model.dofs], np.abs(field), 0.0)
            moved = at_rest & heavy & (speeds > _ROUNDING * speeds.max(initial=0.0))
            if moved.any():
                number = int(np.argmax(np.where(moved, speeds, 0.0)))
                node, dof = model.dofs[number]
                what = f"would move {node} {dof}, which is held, at {field[number]:.4g} {unit}"
                raise InputError(what, key=self.key, value=self._fastness, hint=self.hint)


def _twice_energy(model: LinearModel, field: FloatArray) -> float:
    return float(field @ (model.mass @ field))
