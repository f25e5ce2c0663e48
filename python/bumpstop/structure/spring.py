"""Springs and dampers between a node and the ground, or between two nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TypeAlias

import numpy as np

from bumpstop.arguments import FloatArray, finite, name
from bumpstop.errors import InputError
from bumpstop.structure.assembly import Block
from bumpstop.structure.joint import Joint
from bumpstop.structure.mesh import Mesh
from bumpstop.structure.tensors import Axes, Rows, axes_pair, plain_rows, symmetric, unit_axes

__all__ = ["Spring"]

Constants: TypeAlias = float | Sequence[float] | Sequence[Sequence[float]] | FloatArray


@dataclass(frozen=True)
class Spring:
    """A spring and damper that joins a node to the ground or to another node.

    Stiffness and damping are each given as one number, along the line from the node to the
    other one, or along local x where there are axes; as six numbers, along and about each local
    axis; or as a symmetric 6 x 6 matrix. They act on the motion of the other node relative
    to the first. Where two nodes are apart, the spring sits halfway between them, on rigid
    arms. A 12 x 12 matrix acts on the dofs of both nodes as it is.

    Parameters
    ----------
    name
        Name of the spring.
    node
        The node that it holds.
    other
        The node that holds it; the ground where left out.
    stiffness
        In N/m, N and N m (per rad).
    damping
        In N s/m, N s and N m s.
    axes
        Local x, and a second vector on the side of local y; the global axes where left out.

    Raises
    ------
    InputError
        If a value is not finite, a matrix is not symmetric, or both are left out.

    Examples
    --------
    >>> mount = Spring("mount", node="A", stiffness=(1e6, 1e6, 2e6, 0, 0, 0))
    >>> strut = Spring("strut", node="A", other="B", stiffness=1e5, damping=20.0)
    """

    name: str
    node: str = field(kw_only=True)
    other: str | None = field(default=None, kw_only=True)
    stiffness: Constants | None = field(default=None, kw_only=True)
    damping: Constants | None = field(default=None, kw_only=True)
    axes: Axes | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", name("name", self.name))
        object.__setattr__(self, "node", name("node", self.node))
        if self.other is not None:
            object.__setattr__(self, "other", name("other", self.other))
            if self.other == self.node:
                raise InputError("must be another node", key="other", value=self.other)
        if self.axes is not None:
            object.__setattr__(self, "axes", axes_pair("axes", self.axes))
        if self.stiffness is None and self.damping is None:
            raise InputError("a spring needs stiffness or damping", key="stiffness")
        for key in ("stiffness", "damping"):
            if getattr(self, key) is not None:
                object.__setattr__(self, key, self._constants(key, getattr(self, key)))

    def block(self, mesh: Mesh) -> Block:
        """Return stiffness and damping on the dofs of the spring's nodes.

        Raises
        ------
        InputError
            If it acts along the line between two nodes that are at the same place.
        """
        joint = Joint(mesh, self.node, self.other, f"springs.{self.name}")
        return Block(
            joint.nodes,
            stiffness=self._matrix(joint, self.stiffness),
            damping=self._matrix(joint, self.damping),
        )

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a user should know of this spring, a line each."""
        told = {"stiffness": "pushes away", "damping": "feeds energy"}
        return tuple(
            f"spring {self.name!r} has negative {key}: it {what}"
            for key, what in told.items()
            if _is_negative(getattr(self, key))
        )

    def _matrix(self, joint: Joint, constants: Constants | None) -> FloatArray | None:
        if constants is None:
            return None
        if isinstance(constants, float) and self.axes is None:
            line = self._line(joint)
            return constants * np.outer(line, line)
        if isinstance(constants, float):
            constants = (constants, 0.0, 0.0, 0.0, 0.0, 0.0)
        given = np.array(constants)
        axes = unit_axes(self.axes)
        if given.shape == (12, 12):
            turn = np.kron(np.eye(4), axes)
            matrix: FloatArray = turn.T @ given @ turn
            return 0.5 * (matrix + matrix.T)
        return joint.matrix(np.diag(given) if given.ndim == 1 else given, axes)

    def _line(self, joint: Joint) -> FloatArray:
        """Return the elongation of the line between the nodes by their dofs, (12,)."""
        length = np.linalg.norm(joint.along)
        if length == 0.0:
            raise InputError(
                "has no direction, since its two nodes are at the same place",
                key=f"springs.{self.name}.other",
                value=self.other,
                hint="give axes, or six numbers",
            )
        direction = joint.along / length
        return np.concatenate([-direction, np.zeros(3), direction, np.zeros(3)])

    def _constants(self, key: str, value: object) -> float | tuple[float, ...] | Rows:
        rows = plain_rows(value)
        if not rows:
            if self.other is None and self.axes is None:
                sign = "is negative, and " if finite(key, value) < 0.0 else ""
                hint = "give the other node, or axes, or six numbers"
                what = f"{sign}one number needs a direction"
                raise InputError(what, key=key, value=value, hint=hint)
            return finite(key, value)
        if len(rows) == 6 and not any(isinstance(row, list) for row in rows):
            return tuple(finite(key, number) for number in rows)
        if not all(isinstance(row, list) for row in rows):
            what = "must be a number, six numbers or a symmetric matrix of 6 x 6"
            raise InputError(what, key=key, value=value)
        return symmetric(key, value, (6,) if self.other is None else (6, 12))


def _is_negative(constants: Constants | None) -> bool:
    """Tell whether a stiffness is negative for some motion, beyond the rounding of its numbers."""
    if constants is None:
        return False
    given = np.array(constants)
    values = np.linalg.eigvalsh(given) if given.ndim == 2 else given
    return bool(np.min(values) < -1e-9 * np.abs(values).max())
