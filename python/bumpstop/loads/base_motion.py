"""BaseMotion: all supports move together, and the structure is seen from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

from bumpstop.arguments import FloatArray, Vector, name, vector
from bumpstop.loads.inertia import mass_times
from bumpstop.loads.load import SingleLoad
from bumpstop.loads.time import TimeFunction, time_functions

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.model import LinearModel

__all__ = ["BaseMotion"]


@dataclass(frozen=True)
class BaseMotion(SingleLoad):
    """A translation of all supports, such as an earthquake's; stops move with the supports.

    Displacements, velocities and accelerations of the response are relative to the supports.
    In their frame every mass feels the supports' acceleration as an inertia force: the modal
    forces are the participation factors, ``-Phi' M r a(t)`` with the rigid translation r
    (A. K. Chopra, Dynamics of Structures, section 13.1). In the energy ledger the work of the
    loads is that of these forces.

    Parameters
    ----------
    acceleration
        Components along the global axes, in m/s2, of the supports' acceleration where the
        function of time is one.
    time
        How it changes: a function of time, or a list of functions whose sum is meant; constant
        where left out.
    name
        What the load is called.

    Raises
    ------
    InputError
        If a component is missing or not finite, or something else is no function of time.

    Examples
    --------
    >>> from bumpstop.loads import Harmonic
    >>> BaseMotion(acceleration=(2.0, 0, 0), time=Harmonic(5.0, sine=1.0)).acceleration
    (2.0, 0.0, 0.0)
    """

    _: KW_ONLY
    acceleration: Vector
    time: TimeFunction | Sequence[TimeFunction] | None = None
    name: str = "base_motion"

    def __post_init__(self) -> None:
        name("name", self.name)
        object.__setattr__(self, "acceleration", vector("acceleration", self.acceleration))
        time_functions(self.time)

    @property
    def functions(self) -> tuple[TimeFunction, ...]:
        """The functions of time whose sum it is multiplied by; none where it is constant."""
        return time_functions(self.time)

    def modal_force(self, basis: ModalBasis) -> FloatArray:
        """Return the inertia force on each mode (N,) where the function of time is one.

        Raises
        ------
        InputError
            If the basis was not made from a structure, so that it has no mass matrix.
        """
        return -mass_times(self.acceleration, basis)

    def nodal_force(self, model: LinearModel) -> FloatArray:
        """Return the inertia force on each dof (dofs,) where the function of time is one."""
        return -(model.mass @ model.rigid_field(translation=self.acceleration))
