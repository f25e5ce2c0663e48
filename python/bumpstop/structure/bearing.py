"""Bearings of rotors: stiffness and damping in a plane, of any symmetry."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from bumpstop.arguments import FloatArray, Vector, finite, name, vector
from bumpstop.errors import InputError
from bumpstop.structure.assembly import Block
from bumpstop.structure.frame import local_axes
from bumpstop.structure.joint import Joint
from bumpstop.structure.mesh import Mesh
from bumpstop.structure.tensors import Rows, plain_rows, square

__all__ = ["Bearing"]


@dataclass(frozen=True)
class Bearing:
    """A bearing that holds a node in the plane across its axis.

    Local y and z are those of a beam along the axis. The stiffness matrix
    [[k_yy, k_yz], [k_zy, k_zz]] gives the force on the housing by the displacement of the
    node; its symmetric part counts as stiffness, its skew-symmetric part, from the fluid that
    the rotor drags along, as circulatory. So it is with damping: the skew part is gyroscopic.

    Parameters
    ----------
    name
        Name of the bearing.
    node
        The node that it holds.
    other
        The node of its housing; the ground where left out. Where the two are apart, the
        bearing sits halfway between them, on rigid arms.
    axis
        Direction of the rotor.
    stiffness
        One number for the same in every direction, or a 2 x 2 matrix, in N/m.
    damping
        The same in N s/m.

    Raises
    ------
    InputError
        If a value is not finite, a matrix has another size, or the axis is zero.

    Examples
    --------
    >>> film = Bearing("film", node="A", stiffness=[[2e7, 5e6], [-5e6, 1e7]], damping=1e4)
    """

    name: str
    node: str = field(kw_only=True)
    other: str | None = field(default=None, kw_only=True)
    axis: Vector = field(default=(1.0, 0.0, 0.0), kw_only=True)
    stiffness: float | Sequence[Sequence[float]] | FloatArray = field(kw_only=True)
    damping: float | Sequence[Sequence[float]] | FloatArray = field(default=0.0, kw_only=True)

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", name("name", self.name))
        object.__setattr__(self, "node", name("node", self.node))
        if self.other is not None:
            object.__setattr__(self, "other", name("other", self.other))
            if self.other == self.node:
                raise InputError("must be another node", key="other", value=self.other)
        object.__setattr__(self, "axis", vector("axis", self.axis))
        if not any(self.axis):
            raise InputError("must not be zero", key="axis", value=self.axis)
        for key in ("stiffness", "damping"):
            object.__setattr__(self, key, _in_plane(key, getattr(self, key)))

    def block(self, mesh: Mesh) -> Block:
        """Return the four matrices on the dofs of the bearing's nodes."""
        joint = Joint(mesh, self.node, self.other, f"bearings.{self.name}")
        stiffness, circulatory = self._parts(joint, self.stiffness)
        damping, gyroscopic = self._parts(joint, self.damping)
        return Block(
            joint.nodes,
            stiffness=stiffness,
            damping=damping,
            gyroscopic=gyroscopic,
            circulatory=circulatory,
        )

    def _parts(self, joint: Joint, given: object) -> tuple[FloatArray | None, FloatArray | None]:
        """Return the symmetric and the skew part on the nodes' dofs; None for zero."""
        axes = local_axes(np.zeros(3), np.array(self.axis))
        plane = np.array(given)
        parts = []
        for part in (0.5 * (plane + plane.T), 0.5 * (plane - plane.T)):
            local = np.zeros((6, 6))
            local[1:3, 1:3] = part
            parts.append(joint.matrix(local, axes) if part.any() else None)
        return parts[0], parts[1]


def _in_plane(key: str, value: object) -> Rows:
    if not plain_rows(value):
        constant = finite(key, value)
        return ((constant, 0.0), (0.0, constant))
    return square(key, value, (2,))
