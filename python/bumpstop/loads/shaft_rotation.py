"""ShaftRotation: how the shafts of a structure turn."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, finite, one_of
from bumpstop.errors import InputError
from bumpstop.loads.time import Polynomial, TimeTable, check_span, check_steady

if TYPE_CHECKING:
    from bumpstop import _core

__all__ = ["ShaftRotation"]

ACCELERATION_TERMS = ("lagrange", "fixed_axis", "none")


@dataclass(frozen=True, eq=False)
class ShaftRotation:
    """The speed at which shafts turn, constant or changing as in a run-up.

    The gyroscopic matrix G of a basis, made with some `spin` of its beams and masses, is
    multiplied by the speed W(t) over that. Where W changes, the acceleration W' multiplies a
    matrix beside the stiffness, by one of three conventions for the torque that drives the shaft;
    see ``acceleration_terms``. A constant speed leaves the exact method what it needs; one that
    changes takes an adaptive method.

    Parameters
    ----------
    speed
        Speed W in rad/s: a number, a `Polynomial` in time, or a `TimeTable` without jumps.
    initial_angle
        Angle of the shaft at t = 0, in rad.
    spin
        Speed in rad/s that the gyroscopic matrix of the basis belongs to.
    acceleration_terms
        What W' multiplies. ``"lagrange"``: half of the couplings of G, those of rotations about
        the second axis across the shaft with displacements about the third, as they follow from
        the kinetic energy ``W Jp r_y' r_z`` of a disc; the gyroscopic stiffness matrix of
        rotordynamics programs. It asks for a structure with its shafts along one global axis.
        ``"fixed_axis"``: all of G, for a torque about the axis of the shaft at rest. ``"none"``:
        nothing, for a torque about the axis of the shaft as it is bent.

    Raises
    ------
    InputError
        If the speed is none of these, jumps, or a number is not finite.

    References
    ----------
    M. Lalanne, G. Ferraris, *Rotordynamics Prediction in Engineering*, 2nd edition, Wiley, 1998.

    Examples
    --------
    From rest to 300 rad/s in 10 s:

    >>> run_up = ShaftRotation(Polynomial([0.0, 30.0]))
    >>> run_up.speed_at([10.0]), run_up.angle_at([10.0])
    (array([300.]), array([1500.]))
    """

    speed: float | Polynomial | TimeTable
    _: KW_ONLY
    initial_angle: float = 0.0
    spin: float = 1.0
    acceleration_terms: str = "lagrange"

    def __post_init__(self) -> None:
        if not isinstance(self.speed, Polynomial | TimeTable):
            if not isinstance(self.speed, int | float):
                what = "must be a number, a Polynomial or a TimeTable"
                raise InputError(what, key="speed", value=self.speed)
            object.__setattr__(self, "speed", finite("speed", self.speed))
        elif isinstance(self.speed, TimeTable):
            check_steady([self.speed], "speed")
        object.__setattr__(self, "initial_angle", finite("initial_angle", self.initial_angle))
        object.__setattr__(self, "spin", finite("spin", self.spin))
        if self.spin == 0.0:
            hint = "the speed with which the beams and masses of the basis were made"
            raise InputError("must not be zero", key="spin", value=self.spin, hint=hint)
        one_of("acceleration_terms", self.acceleration_terms, ACCELERATION_TERMS)

    @property
    def constant_speed(self) -> float | None:
        """The speed in rad/s where it does not change."""
        if isinstance(self.speed, float):
            return self.speed
        if isinstance(self.speed, Polynomial):
            first, *others = self.speed.coefficients
            return None if any(others) else first
        values = np.asarray(self.speed.values)
        holds = self.speed.beyond != "zero" or not values[0]
        return float(values[0]) if holds and (values == values[0]).all() else None

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        constant = self.constant_speed
        if constant is not None:
            return f"{constant:g} rad/s"
        return f"a speed that is a {type(self.speed).__name__}"

    def speed_at(self, times: FloatArray | list[float]) -> FloatArray:
        """Return the speed W in rad/s at times in s."""
        return np.asarray(self.core.at(np.asarray(times, dtype=np.float64))[1])

    def angle_at(self, times: FloatArray | list[float]) -> FloatArray:
        """Return the angle in rad at times in s."""
        return np.asarray(self.core.at(np.asarray(times, dtype=np.float64))[0])

    def acceleration_at(self, times: FloatArray | list[float]) -> FloatArray:
        """Return W' in rad/s2 at times in s; just after them where it jumps."""
        return np.asarray(self.core.at(np.asarray(times, dtype=np.float64))[2])

    def check_duration(self, duration: float) -> None:
        """Refuse a table of speeds that does not cover a run and does not say what is beyond.

        Raises
        ------
        InputError
            If it is such.
        """
        if isinstance(self.speed, TimeTable):
            check_span([self.speed], duration, "speed")

    @cached_property
    def core(self) -> _core.Course:
        """How the shaft turns, as the core sees it."""
        from bumpstop import _core

        return _core.Course(self.initial_angle, self._stretches())

    def _stretches(self) -> list[tuple[float, list[float]]]:
        """Return where polynomials of the speed begin, and their coefficients from there."""
        if isinstance(self.speed, float):
            return [(0.0, [self.speed])]
        if isinstance(self.speed, Polynomial):
            return [(0.0, list(self.speed.coefficients))]
        table = self.speed
        knots = np.unique(np.asarray(table.times))
        knots = np.concatenate([[0.0], knots[knots > 0.0]])
        values = table.at(knots)
        if table.beyond == "zero":
            # A table without jumps ends in zero, which its last instant is told with.
            values[knots >= float(table.times[-1])] = 0.0
        elif len(knots) > 1:
            values[-1] = float(np.asarray(table.values)[-1])
        slopes = np.append(np.diff(values) / np.diff(knots), 0.0)
        both = zip(knots.tolist(), values.tolist(), slopes.tolist(), strict=True)
        return [(start, [value, slope]) for start, value, slope in both]
