"""Masses without size."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from bumpstop.arguments import name, positive
from bumpstop.structure.assembly import Block
from bumpstop.structure.mesh import Mesh

__all__ = ["PointMass"]


@dataclass(frozen=True)
class PointMass:
    """A mass at a node, the same in every direction, without rotary inertia.

    Parameters
    ----------
    name
        Name of the mass.
    node
        The node that carries it.
    mass
        Mass in kg.

    Raises
    ------
    InputError
        If the mass is not a finite positive number.
    """

    name: str
    node: str = field(kw_only=True)
    mass: float = field(kw_only=True)

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", name("name", self.name))
        object.__setattr__(self, "node", name("node", self.node))
        object.__setattr__(self, "mass", positive("mass", self.mass))

    def block(self, mesh: Mesh) -> Block:
        """Return the mass on ``dx dy dz`` of the node."""
        node = mesh.node(self.node, f"masses.{self.name}.node")
        mass = np.diag([self.mass] * 3 + [0.0] * 3)
        return Block(np.array([node]), mass=mass)
