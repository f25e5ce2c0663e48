"""The force of an acceleration on everything that has mass."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING

from bumpstop.arguments import FloatArray, Vector
from bumpstop.errors import InputError
from bumpstop.loads.load import SingleLoad

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.cut import Cut
    from bumpstop.structure.model import LinearModel

__all__ = ["InertialLoad", "mass_times"]


class InertialLoad(SingleLoad):
    """A load that is masses times an acceleration."""

    @abstractmethod
    def pull(self, model: LinearModel) -> FloatArray:
        """Return the acceleration that masses feel at each dof (dofs,), in m/s2 and rad/s2.

        It is that where the function of time is one.
        """

    def nodal_force(self, model: LinearModel) -> FloatArray:
        """Return the force on each dof of a model, (dofs,), where the function of time is one."""
        return model.mass @ self.pull(model)

    def inside(self, cut: Cut) -> FloatArray:
        """Return what the mass of an element does inside it, (r, 1)."""
        return cut.of_inertia(self.pull(cut.model).reshape(-1, 1))


def mass_times(acceleration: Vector, basis: ModalBasis) -> FloatArray:
    """Return the masses times a uniform acceleration in m/s2, on each mode (N,).

    Raises
    ------
    InputError
        If the basis was not made from a structure, so that it has no mass matrix.
    """
    if basis.model is None or basis.mass_rows is None:
        hint = "give a NodalForce, or make the basis from a structure"
        raise InputError("needs the masses of a structure", key="acceleration", hint=hint)
    return basis.mass_rows @ basis.model.rigid_field(translation=acceleration)
