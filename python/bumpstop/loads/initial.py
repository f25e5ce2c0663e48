"""Initial states: where the structure is and how it moves at t = 0."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from bumpstop.arguments import FloatArray, Vector, name, series, vector
from bumpstop.errors import InputError
from bumpstop.loads.velocity_field import VelocityField

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.model import LinearModel

__all__ = ["ModalState", "RigidRotation"]


@dataclass(frozen=True)
class ModalState:
    """Displacement and velocity of each vector of the basis as its user gave it.

    Parameters
    ----------
    displacement
        Amplitudes (U,), one for each of the basis' ``labels``: in m kg^0.5 for vectors of unit
        modal mass, as modes are; all zero where left out.
    velocity
        Their rates (U,), per s; all zero where left out.

    Raises
    ------
    InputError
        If a list is empty or a number not finite.

    Examples
    --------
    >>> ModalState(velocity=[0.2, 0.0])
    ModalState(displacement=None, velocity=(0.2, 0.0))
    """

    _: KW_ONLY
    displacement: Sequence[float] | FloatArray | None = None
    velocity: Sequence[float] | FloatArray | None = None

    def __post_init__(self) -> None:
        for key in ("displacement", "velocity"):
            given = getattr(self, key)
            if given is not None:
                object.__setattr__(self, key, series(key, given))

    def modal_state(self, basis: ModalBasis) -> tuple[FloatArray, FloatArray]:
        """Return displacement and velocity of the canonical modes, each (N,).

        Raises
        ------
        InputError
            If a list has not one number a vector.
        """
        displacement = _one_a_vector("displacement", self.displacement, basis.labels)
        velocity = _one_a_vector("velocity", self.velocity, basis.labels)
        return basis.canonical(displacement), basis.canonical(velocity)

    def remarks(self, _: ModalBasis) -> tuple[str, ...]:
        """Return nothing: the basis has all of a state that is given in its own vectors."""
        return ()


@dataclass(frozen=True)
class RigidRotation(VelocityField):
    """A velocity field: the whole structure turns about a node, undeformed.

    A node at x moves with ``rate x (x - about)`` and turns with ``rate``; the field is
    projected on the modes with the mass matrix. Whatever supports hold must stay at rest.

    Parameters
    ----------
    about
        Name of the node that the structure turns about.
    rate
        Angular velocity about the global axes, in rad/s.

    Raises
    ------
    InputError
        If a component is missing or not finite.

    Examples
    --------
    >>> RigidRotation(about="A", rate=(0, 0, -3.8)).rate
    (0.0, 0.0, -3.8)
    """

    about: str
    rate: Vector

    motion: ClassVar[str] = "rotation"
    key: ClassVar[str] = "rate"
    hint: ClassVar[str] = "turn about a hinge, and only about axes that the supports leave free"

    def __post_init__(self) -> None:
        name("about", self.about)
        object.__setattr__(self, "rate", vector("rate", self.rate))

    def field(self, model: LinearModel) -> FloatArray:
        """Return the velocity of each dof, in m/s and rad/s, (dofs,).

        Raises
        ------
        InputError
            If the model has no such node.
        """
        centre = _position(model, self.about)
        return model.rigid_field(rotation=self.rate, about=centre)


def _position(model: LinearModel, about: str) -> Vector:
    try:
        return model.position(about)
    except InputError as error:
        raise InputError(error.what, key="about", value=about, hint=error.hint) from error


def _one_a_vector(
    key: str, values: Sequence[float] | FloatArray | None, labels: Sequence[str]
) -> FloatArray:
    if values is None:
        return np.zeros(len(labels))
    if len(values) != len(labels):
        modes = all(label.startswith("mode ") for label in labels)
        what = (
            f"must have one number for each of the {len(labels)} {'modes' if modes else 'vectors'}"
        )
        hint = None if modes else f"they are {', '.join(labels)}"
        raise InputError(what, key=key, value=f"{len(values)} numbers", hint=hint)
    return np.array(values)
