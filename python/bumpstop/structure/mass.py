"""Masses at a node: points, rigid bodies and spinning discs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from bumpstop.arguments import FloatArray, Vector, finite, name, not_negative, vector
from bumpstop.errors import InputError
from bumpstop.structure.assembly import Block
from bumpstop.structure.frame import rigid_motions
from bumpstop.structure.mesh import Mesh
from bumpstop.structure.tensors import Axes, Rows, axes_pair, plain_rows, symmetric, unit_axes

__all__ = ["PointMass"]

_ROUNDING = 1e-9
"""Inertia this small beside the largest moment is what numbers of ten digits leave."""


@dataclass(frozen=True)
class PointMass:
    """A rigid body that moves with a node; a mass without size where it has no inertia.

    Parameters
    ----------
    name
        Name of the mass.
    node
        The node that carries it.
    mass
        Mass in kg; it may be zero where there is inertia.
    inertia
        Moments of inertia about its centre of mass, in kg m2, in its own axes: three for
        principal axes, six (xx, yy, zz, xy, yz, xz) or a symmetric 3 x 3 matrix. The products
        are entries of that matrix: xy is minus the integral of x y over the mass. No principal
        moment may exceed the sum of the other two, as those of no body do; one alone is taken.
    offset
        Its centre of mass from the node, along the global axes, in m.
    axes
        Its own axes: local x, and a second vector on the side of local y; the global axes
        where left out.
    spin
        Speed in rad/s at which it turns about its local x, constant in time: its angular
        momentum makes the gyroscopic matrix.

    Raises
    ------
    InputError
        If a value is not finite, the mass is negative or nothing, the inertia is negative, not
        symmetric or that of no body, or what spins is not round.

    Examples
    --------
    >>> disc = PointMass("disc", node="C", mass=8.0, inertia=(0.04, 0.02, 0.02), spin=500.0)
    """

    name: str
    node: str = field(kw_only=True)
    mass: float = field(kw_only=True)
    inertia: Sequence[float] | Sequence[Sequence[float]] | FloatArray | None = field(
        default=None, kw_only=True
    )
    offset: Vector = field(default=(0.0, 0.0, 0.0), kw_only=True)
    axes: Axes | None = field(default=None, kw_only=True)
    spin: float = field(default=0.0, kw_only=True)

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", name("name", self.name))
        object.__setattr__(self, "node", name("node", self.node))
        object.__setattr__(self, "mass", not_negative("mass", self.mass))
        object.__setattr__(self, "offset", vector("offset", self.offset))
        object.__setattr__(self, "spin", finite("spin", self.spin))
        if self.inertia is not None:
            object.__setattr__(self, "inertia", _inertia(self.inertia))
        elif self.mass == 0.0:
            raise InputError("must be positive", key="mass", value=self.mass)
        if self.axes is not None:
            object.__setattr__(self, "axes", axes_pair("axes", self.axes))
        if self.spin != 0.0:
            self._require_round()

    def block(self, mesh: Mesh) -> Block:
        """Return the mass, and what its spin adds, on the six dofs of the node."""
        node = np.array([mesh.node(self.node, f"masses.{self.name}.node")])
        arm = rigid_motions(np.array([self.offset]), np.zeros(3))
        axes = unit_axes(self.axes)
        body = np.diag([self.mass] * 3 + [0.0] * 3)
        body[3:, 3:] = axes.T @ self._tensor @ axes
        mass = arm.T @ body @ arm
        mass = 0.5 * (mass + mass.T)
        if self.spin == 0.0:
            return Block(node, mass=mass)
        return Block(node, mass=mass, gyroscopic=self._gyroscopic(axes[0]))

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a user should know of this mass, a line each."""
        if np.count_nonzero(_principal(self._tensor)) != 1:
            return ()
        return (f"mass {self.name!r} has inertia about one axis alone, which no body has",)

    @property
    def _tensor(self) -> FloatArray:
        """Inertia in the body's own axes, (3, 3)."""
        return np.zeros((3, 3)) if self.inertia is None else np.array(self.inertia)

    def _gyroscopic(self, axis: FloatArray) -> FloatArray:
        """Return the matrix of the moment that turns the angular momentum with the node."""
        momentum = self.spin * self._tensor[0, 0]
        matrix = np.zeros((6, 6))
        matrix[3:, 3:] = momentum * np.cross(np.eye(3), axis).T
        return matrix

    def _require_round(self) -> None:
        """Raise where the gyroscopic matrix of a constant speed has no meaning."""
        tensor = self._tensor
        round_one = np.diag([tensor[0, 0], tensor[1, 1], tensor[1, 1]])
        if not np.allclose(tensor, round_one, rtol=0.0, atol=1e-9 * np.abs(tensor).max()):
            what = "what spins must have the same inertia about local y as about z"
            raise InputError(what, key="inertia", value=self.inertia)
        if math.isclose(tensor[0, 0], 0.0):
            hint = "the first of its moments of inertia is that about the axis"
            raise InputError("what spins needs inertia", key="inertia", hint=hint)


def _inertia(value: object) -> Rows:
    """Return the rows of an inertia tensor, given by three, six or nine numbers."""
    rows = plain_rows(value)
    if len(rows) in (3, 6) and not any(isinstance(row, list) for row in rows):
        xx, yy, zz, xy, yz, xz = [finite("inertia", number) for number in rows] + [0.0] * (
            6 - len(rows)
        )
        rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
    elif len(rows) != 3:
        what = "must be three or six numbers, or a symmetric matrix of 3 x 3"
        raise InputError(what, key="inertia", value=value)
    tensor = symmetric("inertia", rows, (3,))
    least, middle, largest = _principal(np.array(tensor))
    if least < 0.0:
        raise InputError("no moment of inertia may be negative", key="inertia", value=value)
    if middle > 0.0 and largest > (least + middle) * (1.0 + _ROUNDING):
        what = f"no body has principal moments of {least:.6g}, {middle:.6g} and {largest:.6g}"
        hint = "each is at most the sum of the other two"
        raise InputError(what, key="inertia", value=value, hint=hint)
    return tensor


def _principal(tensor: FloatArray) -> FloatArray:
    """Return the principal moments, (3,), ascending; rounding beside the largest is zero."""
    moments: FloatArray = np.array(np.linalg.eigvalsh(tensor), dtype=np.float64)
    moments[np.abs(moments) <= _ROUNDING * np.abs(moments).max()] = 0.0
    return moments
