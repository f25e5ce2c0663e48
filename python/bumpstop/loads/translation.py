"""RigidTranslation: the structure, or some of it, flies along a straight line at t = 0."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from bumpstop.arguments import FloatArray, Vector, did_you_mean, vector
from bumpstop.errors import InputError
from bumpstop.loads.velocity_field import VelocityField
from bumpstop.structure.model import BeamModel
from bumpstop.structure.names import names

if TYPE_CHECKING:
    from bumpstop.structure.model import LinearModel

__all__ = ["RigidTranslation"]


@dataclass(frozen=True)
class RigidTranslation(VelocityField):
    """A velocity field: nodes move alike along a straight line and do not turn.

    The field is projected on the modes with the mass matrix. Between a node that moves and one
    that does not, it follows the shape functions of the beam that joins them. Whatever supports
    hold must stay at rest.

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

    motion: ClassVar[str] = "translation"
    key: ClassVar[str] = "velocity"
    hint: ClassVar[str] = "name the nodes that move, without those that supports hold"

    def __post_init__(self) -> None:
        object.__setattr__(self, "velocity", vector("velocity", self.velocity))
        for key in ("nodes", "beams"):
            given = getattr(self, key)
            if given is not None:
                object.__setattr__(self, key, names(key, given))

    def field(self, model: LinearModel) -> FloatArray:
        """Return the velocity of each dof, in m/s and rad/s, (dofs,).

        Raises
        ------
        InputError
            If the model has no such node or beam.
        """
        field = model.rigid_field(translation=self.velocity)
        if self.nodes is None and self.beams is None:
            return field
        moving = self._moving(model)
        return np.where([node in moving for node, _ in model.dofs], field, 0.0)

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
