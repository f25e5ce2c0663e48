"""Rigid links: nodes that move with another one as a rigid body does."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from bumpstop.arguments import Vector, name, one_of, refuse_twins
from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.forms import LinearForm
from bumpstop.structure.frame import rigid_motions
from bumpstop.structure.names import names

__all__ = ["RigidLink"]


@dataclass(frozen=True)
class RigidLink:
    """Nodes that follow the motion of a first one, as if a rigid body joined them.

    A node at the offset r from the first, which moves by u and turns by the small angle t,
    moves by u + t x r and turns by t. With some dofs only, the others stay free: ``dx dy dz``
    of two nodes at one place make a ball joint, and with ``drx dry`` besides a hinge about z.

    Parameters
    ----------
    name
        Name of the link.
    nodes
        The node that leads, and then those that follow it. Each may also be a point along a
        beam (``"AB@0.462"``).
    dofs
        The dofs of the following nodes that are tied; all six by default.

    Raises
    ------
    InputError
        If there are fewer than two nodes, one is named twice, or a dof is unknown.
    """

    name: str
    nodes: Sequence[str] = field(kw_only=True)
    dofs: Sequence[str] = field(default=DOFS, kw_only=True)

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", name("name", self.name))
        object.__setattr__(self, "nodes", names("nodes", self.nodes))
        object.__setattr__(self, "dofs", names("dofs", self.dofs))
        if len(self.nodes) < 2:
            hint = "the node that leads, and those that follow"
            raise InputError(
                "must name two nodes or more", key="nodes", value=self.nodes, hint=hint
            )
        refuse_twins("nodes", self.nodes)
        for dof in self.dofs:
            one_of("dofs", dof, DOFS)
        refuse_twins("dofs", self.dofs)

    def forms(
        self,
        position: Callable[[str], Vector],
        displacement_form: Callable[[str, str], LinearForm],
    ) -> list[LinearForm]:
        """Return the sums that stay zero, one for each dof that follows; it comes first."""
        leader, *followers = self.nodes
        place = np.array(position(leader))
        leading = [displacement_form(leader, dof) for dof in DOFS]
        forms = []
        for follower in followers:
            motions = rigid_motions(np.array([position(follower)]), place)
            for dof in self.dofs:
                weights = motions[DOFS.index(dof)]
                parts = [(-w, form) for w, form in zip(weights, leading, strict=True) if w != 0.0]
                forms.append(LinearForm.sum([(1.0, displacement_form(follower, dof)), *parts]))
        return forms
