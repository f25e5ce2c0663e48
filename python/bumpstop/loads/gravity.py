"""Gravity: a uniform acceleration of everything that has mass."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

from bumpstop.arguments import FloatArray, Vector, name, vector
from bumpstop.loads.inertia import InertialLoad, mass_times

if TYPE_CHECKING:
    from bumpstop.loads.time import TimeFunction
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.model import LinearModel

__all__ = ["Gravity"]


@dataclass(frozen=True)
class Gravity(InertialLoad):
    """The weight of the structure, from t = 0 on: the mass matrix times an acceleration.

    Parameters
    ----------
    name
        What the load is called.
    acceleration
        Components along the global axes, in m/s2.

    Raises
    ------
    InputError
        If a component is missing or not finite.

    Examples
    --------
    >>> Gravity("weight", acceleration=(0, 0, -9.81)).acceleration
    (0.0, 0.0, -9.81)
    """

    name: str
    _: KW_ONLY
    acceleration: Vector

    def __post_init__(self) -> None:
        name("name", self.name)
        object.__setattr__(self, "acceleration", vector("acceleration", self.acceleration))

    @property
    def functions(self) -> tuple[TimeFunction, ...]:
        """No functions of time: it is constant."""
        return ()

    def modal_force(self, basis: ModalBasis) -> FloatArray:
        """Return the weight on each mode (N,), for unit modal mass.

        Raises
        ------
        InputError
            If the basis was not made from a structure, so that it has no mass matrix.
        """
        return mass_times(self.acceleration, basis)

    def pull(self, model: LinearModel) -> FloatArray:
        """Return the acceleration that masses feel at each dof, (dofs,)."""
        return model.rigid_field(translation=self.acceleration)
