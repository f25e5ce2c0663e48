"""BaseMotion: all supports move together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

from bumpstop.arguments import FloatArray, Vector, name, one_of
from bumpstop.loads.inertia import InertialLoad, mass_times
from bumpstop.loads.moving_supports import MovingSupports
from bumpstop.loads.time import TimeFunction

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.model import LinearModel

__all__ = ["FRAMES", "BaseMotion"]

FRAMES = ("relative", "absolute")


@dataclass(frozen=True)
class BaseMotion(InertialLoad, MovingSupports):
    """A translation of all supports, such as an earthquake's; stops move with the supports.

    In the frame of the supports every mass feels their acceleration as an inertia force: the
    modal forces are the participation factors, ``-Phi' M r a(t)`` with the rigid translation r
    (A. K. Chopra, Dynamics of Structures, section 13.1). In the energy ledger the work of the
    loads is that of these forces, and the kinetic energy that of the motion from the supports.
    Initial states are those seen from the supports. A stop with the frame "absolute" stands still
    while the supports move.

    Parameters
    ----------
    acceleration
        Components along the global axes, in m/s2, of the supports' acceleration where the
        function of time is one; the supports start at rest.
    displacement
        Instead: components of their displacement in m; harmonics and polynomials multiply it.
    time
        How it changes: a function of time, or a list of functions whose sum is meant; an
        acceleration is constant where left out.
    frame
        From where results tell displacements, velocities and accelerations: ``"relative"`` to
        the supports, or ``"absolute"``.
    name
        What the load is called.

    Raises
    ------
    InputError
        If a component is missing or not finite, or something else is no function of time; if
        there is neither acceleration nor displacement, or both.

    Examples
    --------
    >>> from bumpstop.loads import Harmonic
    >>> BaseMotion(acceleration=(2.0, 0, 0), time=Harmonic(5.0, sine=1.0)).acceleration
    (2.0, 0.0, 0.0)
    """

    _: KW_ONLY
    acceleration: Vector | None = None
    displacement: Vector | None = None
    time: TimeFunction | Sequence[TimeFunction] | None = None
    frame: str = "relative"
    name: str = "base_motion"

    def __post_init__(self) -> None:
        name("name", self.name)
        one_of("frame", self.frame, FRAMES)
        self._check_motion()

    @property
    def functions(self) -> tuple[TimeFunction, ...]:
        """The functions of time whose sum it is multiplied by; none where it is constant."""
        return self.accelerations

    @property
    def is_absolute(self) -> bool:
        """Whether results are told as seen from the still ground."""
        return self.frame == "absolute"

    def field(self, model: LinearModel) -> FloatArray:
        """Return how all dofs are carried where the function of time is one, (dofs,)."""
        return model.rigid_field(translation=self.size)

    def modal_force(self, basis: ModalBasis) -> FloatArray:
        """Return the inertia force on each mode (N,) where the function of time is one.

        Raises
        ------
        InputError
            If the basis was not made from a structure, so that it has no mass matrix.
        """
        return -mass_times(self.size, basis)

    def pull(self, model: LinearModel) -> FloatArray:
        """Return the acceleration that masses feel at each dof (dofs,), against the base's."""
        return -self.field(model)
