"""RigidTranslation: the structure, or some of it, flies along a straight line at t = 0."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, Vector, did_you_mean, vector
from bumpstop.errors import InputError
from bumpstop.structure.model import BeamModel
from bumpstop.structure.names import names

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.model import LinearModel

__all__ = ["RigidTranslation"]


@dataclass(frozen=True)
class RigidTranslation:
    """A velocity field: nodes move alike along a straight line and do not turn.

    The field is projected on the modes with the mass matrix. Between a node that moves and one
    that does not, it follows the shape functions of the beam that joins them.

    Parameters
    ----------
    velocity
        Velocity along the global axes, in m/s.
    nodes, beams
        What moves: nodes, and all nodes of beams; the whole structure where neither is given.

    Raises
    ------
    InputError
        If a component is missing or not finite, or a name is not one.

    Examples
    --------
    >>> RigidTranslation((-1, 0, 0), beams="front").beams
    ('front',)
    """

    velocity: Vector
    _: KW_ONLY
    nodes: str | Sequence[str] | None = None
    beams: str | Sequence[str] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "velocity", vector("velocity", self.velocity))
        for key in ("nodes", "beams"):
            given = getattr(self, key)
            if given is not None:
                object.__setattr__(self, key, names(key, given))

    def modal_state(self, basis: ModalBasis) -> tuple[FloatArray, FloatArray]:
        """Return modal displacement, which is zero, and velocity, each (N,).

        Raises
        ------
        InputError
            If the basis was not made from a structure, the structure has no such node or beam,
            or no mode takes part in the translation.
        """
        if basis.model is None:
            hint = "give a ModalState, or make the basis from a structure"
            raise InputError("needs a structure to move", key="velocity", hint=hint)
        field = basis.model.rigid_field(translation=self.velocity)
        if self.nodes is not None or self.beams is not None:
            moving = self._moving(basis.model)
            field = np.where([node in moving for node, _ in basis.model.dofs], field, 0.0)
        velocity = basis.project_field(field)
        if any(self.velocity) and not velocity.any():
            what = "no mode takes part in this translation"
            raise InputError(what, key="velocity", value=self.velocity)
        return np.zeros(len(velocity)), velocity

    def _moving(self, model: LinearModel) -> set[str]:
        known = dict.fromkeys(node for node, _ in model.dofs)
        moving = set(self.nodes or ())
        for node in self.nodes or ():
            if node not in known:
                hint = did_you_mean(node, known)
                raise InputError("unknown node", key="nodes", value=node, hint=hint)
        for beam in self.beams or ():
            if not isinstance(model, BeamModel):
                raise InputError("the structure has no beams", key="beams", value=beam)
            moving.update(model.beam_nodes(beam))
        return moving
