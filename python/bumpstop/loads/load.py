"""What loads of one shape in space have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray

if TYPE_CHECKING:
    from bumpstop.loads.time import TimeFunction
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.cut import Cut
    from bumpstop.structure.model import LinearModel

__all__ = ["ForceComponent", "SingleLoad"]


class ForceComponent(NamedTuple):
    """A vector of modal forces times a function of time."""

    force: FloatArray
    """On each mode where the function of time is one, (N,)."""
    functions: tuple[TimeFunction, ...]
    """The functions whose sum it is multiplied by; none where it is constant."""


class SingleLoad(ABC):
    """A load that is one vector times one function of time."""

    @property
    @abstractmethod
    def functions(self) -> tuple[TimeFunction, ...]:
        """The functions of time whose sum it is multiplied by; none where it is constant."""

    @abstractmethod
    def modal_force(self, basis: ModalBasis) -> FloatArray:
        """Return the force on each mode (N,) where the function of time is one."""

    @abstractmethod
    def nodal_force(self, model: LinearModel) -> FloatArray:
        """Return the force on each dof of a model, (dofs,), where the function of time is one."""

    def nodal_forces(self, model: LinearModel) -> FloatArray:
        """Return the same as a column, (dofs, 1)."""
        return self.nodal_force(model)[:, np.newaxis]

    def components(self, basis: ModalBasis) -> tuple[ForceComponent, ...]:
        """Return the force on each mode with its functions of time."""
        return (ForceComponent(self.modal_force(basis), self.functions),)

    def inside(self, cut: Cut) -> FloatArray:
        """Return what it does at a place inside an element whose ends are held, (r, 1).

        What acts on nodes does nothing there.
        """
        return np.zeros((len(cut.kernel(cut.at)), 1))
