"""Unbalance: a mass out of the centre of a shaft that turns."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, Vector, finite, name, not_negative
from bumpstop.errors import InputError
from bumpstop.laws.coordinate import unit
from bumpstop.loads.load import ForceComponent
from bumpstop.loads.shaft_rotation import ShaftRotation
from bumpstop.loads.time import Harmonic, Term, TimeFunction
from bumpstop.projection import direction_row
from bumpstop.structure.dofs import DOFS

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.model import LinearModel

__all__ = ["Unbalance", "Whirl"]


@dataclass(frozen=True, eq=False)
class Unbalance:
    """The force of a mass m at the distance e from the centre of a shaft.

    With the angle of the shaft, and that of the mass in it, ``a = angle + phase``, the speed
    W and the axes y and z across the shaft, the force is
    ``m e (W^2 cos a + W' sin a)`` along y and ``m e (W^2 sin a - W' cos a)`` along z.

    Parameters
    ----------
    name
        What the load is called.
    node
        The node it acts on: a node's name or a point along a beam.
    rotation
        How the shaft turns.
    moment
        m e in kg m; or ``mass`` and ``eccentricity`` instead.
    mass, eccentricity
        m in kg and e in m.
    phase
        Angle of the mass in the shaft, in rad, from the first axis across to the second.
    axis
        Direction of the shaft. The first axis across is the part of the global y axis across it,
        or that of the z axis where these are one; the second is the axis times it.

    Raises
    ------
    InputError
        If a number is not finite or below zero, the axis has no length, or ``moment`` is given
        beside mass and eccentricity.

    Examples
    --------
    >>> import bumpstop as bs
    >>> disc = bs.ModalBasis.from_modes(
    ...     frequency=[8.0, 8.0], shapes={("D", "dy"): [1.0, 0.0], ("D", "dz"): [0.0, 1.0]}
    ... )
    >>> steady = bs.ShaftRotation(10.0)
    >>> load = Unbalance("unbalance", node="D", rotation=steady, mass=0.5, eccentricity=2e-3)
    >>> load.moment, len(load.components(disc))
    (0.001, 2)
    """

    name: str
    _: KW_ONLY
    node: str
    rotation: ShaftRotation
    moment: float | None = None
    mass: float | None = None
    eccentricity: float | None = None
    phase: float = 0.0
    axis: Vector = (1.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        name("name", self.name)
        name("node", self.node)
        if not isinstance(self.rotation, ShaftRotation):
            raise InputError("must be a ShaftRotation", key="rotation", value=self.rotation)
        object.__setattr__(self, "moment", self._moment())
        object.__setattr__(self, "phase", finite("phase", self.phase))
        object.__setattr__(self, "axis", unit("axis", self.axis))

    def _moment(self) -> float:
        parts = {"mass": self.mass, "eccentricity": self.eccentricity}
        if self.moment is None:
            for key, value in parts.items():
                if value is None:
                    hint = "give moment, in kg m, or mass and eccentricity"
                    raise InputError("is missing", key=key, hint=hint)
            sizes = [not_negative(key, value) for key, value in parts.items()]
            return math.prod(sizes)
        moment = not_negative("moment", self.moment)
        told = [value for value in parts.values() if value is not None]
        if told and (len(told) < len(parts) or math.prod(told) != moment):
            what = "is told by mass and eccentricity already"
            raise InputError(what, key="moment", value=moment, hint="give either")
        return moment

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        return f"unbalance of {self.moment:g} kg m at {self.node}, {self.rotation.words}"

    def whirling(self, basis: ModalBasis) -> tuple[FloatArray, FloatArray]:
        """Return the forces on each mode, (N,), at 1 rad/s and angles of 0 and a quarter turn.

        Raises
        ------
        InputError
            If the basis has no shape at the node across the shaft.
        """
        first, second = (direction_row(basis, self.node, each) for each in self._across)
        return self._turned(first, second)

    def components(self, basis: ModalBasis) -> tuple[ForceComponent, ...]:
        """Return the force on each mode with its functions of time."""
        both = zip(self.whirling(basis), self._functions, strict=True)
        return tuple(ForceComponent(force, (function,)) for force, function in both)

    def nodal_forces(self, model: LinearModel) -> FloatArray:
        """Return the forces on each dof of a model that the functions belong to, (dofs, 2)."""
        forces = []
        for direction in self._across:
            total = np.zeros(len(model.dofs))
            for dof, part in zip(DOFS, direction, strict=False):
                if part != 0.0:
                    form = model.displacement_form(self.node, dof)
                    np.add.at(total, form.dofs, part * form.weights)
            forces.append(total)
        return np.stack(self._turned(*forces), axis=1)

    def _turned(self, first: FloatArray, second: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return forces of the mass where the shaft's angle is zero, and a quarter turn."""
        assert self.moment is not None
        cos, sin = self.moment * math.cos(self.phase), self.moment * math.sin(self.phase)
        return cos * first + sin * second, cos * second - sin * first

    @property
    def _across(self) -> FloatArray:
        from bumpstop.laws.around_axis import plane_axes

        return plane_axes(self.axis)[:2]

    @property
    def _functions(self) -> tuple[TimeFunction, TimeFunction]:
        """Return what both forces are multiplied by."""
        speed = self.rotation.constant_speed
        if speed is None or speed == 0.0:
            return Whirl(self.rotation, 0.0), Whirl(self.rotation, 0.5 * math.pi)
        start, sign, size = self.rotation.initial_angle, math.copysign(1.0, speed), speed * speed
        cos, sin = size * math.cos(start), size * math.sin(start)
        frequency = abs(speed) / (2.0 * math.pi)
        return (
            Harmonic(frequency, cosine=cos, sine=-sign * sin),
            Harmonic(frequency, cosine=sin, sine=sign * cos),
        )


@dataclass(frozen=True, eq=False)
class Whirl:
    """``W^2 cos a + W' sin a`` with the angle of a shaft, a, less an angle of its own.

    Parameters
    ----------
    rotation
        How the shaft turns.
    lag
        What is taken off the angle, in rad.
    """

    rotation: ShaftRotation
    lag: float

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        return f"the whirl of {self.rotation.words}"

    def at(self, times: FloatArray) -> FloatArray:
        """Return its values at some times in s."""
        angle = self.rotation.angle_at(times) - self.lag
        speed, acceleration = self.rotation.speed_at(times), self.rotation.acceleration_at(times)
        values: FloatArray = speed**2 * np.cos(angle) + acceleration * np.sin(angle)
        return values

    def terms(self, duration: float) -> tuple[Term, ...]:  # noqa: ARG002  # the same for any
        """Return no terms: the core follows the shaft itself."""
        return ()
