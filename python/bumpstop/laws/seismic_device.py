"""SeismicDevice: a spring that softens beyond a threshold, with a power-law damper."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from bumpstop.arguments import FloatArray, finite, not_negative, positive
from bumpstop.errors import InputError
from bumpstop.laws.connection import Connection

if TYPE_CHECKING:
    from bumpstop import _core
    from bumpstop.modal.basis import ModalBasis

__all__ = ["SeismicDevice"]


@dataclass(frozen=True)
class SeismicDevice(Connection):
    """A prestressed viscous spring damper, as they protect buildings and piping.

    With the elongation x and its speed v the force on the node is ``-(f(x) + g(x, v))`` along the
    direction, and the opposite on the other node::

        f = k2 x + (k1 - k2) x / sqrt(1 + (k1 x / threshold)^2)
        g = damping sign(v) |v x / stroke|^exponent

    The spring is elastic, without a loop of its own. Around rest, at speeds like ``rest_speed``,
    the damper goes over to a linear one: v / (v^2 + rest_speed^2)^((1 - exponent)/2) stands for
    the power of the speed. The adaptive methods take it, and the schemes of fixed steps.

    Parameters
    ----------
    name
        What the device is called in results.
    node
        The node that it holds: a node's name or a point along a beam (``"AB@0.462"``).
    direction
        Direction along which it acts, in global axes; any length but zero, kept as a unit
        vector.
    other
        The node that holds it; the ground where left out.
    terms
        Instead of node, direction and other: the weight of each (node, dof) in the elongation.
    first_stiffness
        k1 in N/m, at small elongations.
    second_stiffness
        k2 in N/m, at large ones, not above the first.
    threshold
        Force in N around which the stiffness changes.
    damping
        Force in N of the damper where ``|v x / stroke|`` is 1 m/s.
    exponent
        Power of the damper, above 0 and at most 1.
    stroke
        Elongation in m that the damper's is measured by.
    rest_speed
        Speed in m/s below which the damper is linear. The smaller, the shorter are the steps
        that follow a mass which comes to rest.

    Raises
    ------
    InputError
        If a number is out of its range.

    References
    ----------
    The anti-seismic device of code_aster's manual R5.06.03.

    Examples
    --------
    >>> device = SeismicDevice(
    ...     "device", node="P", direction=(1, 0, 0), first_stiffness=6e6,
    ...     second_stiffness=0.53e6, threshold=1200.0, damping=7000.0, exponent=0.2, stroke=0.03,
    ... )
    >>> device.force([1e-5, 0.02]).round(1).tolist()
    [59.9, 11693.9]
    """

    kind: ClassVar[str] = "device"
    smooth: ClassVar[str] = "its damper follows a power of the speed"
    """Why it is not piecewise linear."""

    _: KW_ONLY
    first_stiffness: float
    second_stiffness: float
    threshold: float
    damping: float = 0.0
    exponent: float = 1.0
    stroke: float = 1.0
    rest_speed: float = 1e-6

    def __post_init__(self) -> None:
        super().__post_init__()
        for key in ("first_stiffness", "threshold", "exponent", "stroke", "rest_speed"):
            object.__setattr__(self, key, positive(key, getattr(self, key)))
        for key in ("second_stiffness", "damping"):
            object.__setattr__(self, key, not_negative(key, getattr(self, key)))
        if self.second_stiffness > self.first_stiffness:
            what, value = "must not exceed the first stiffness", self.second_stiffness
            raise InputError(what, key="second_stiffness", value=value)
        if self.exponent > 1.0:
            raise InputError("must not exceed 1", key="exponent", value=self.exponent)

    def force(self, elongation: FloatArray | Sequence[float], speed: float = 0.0) -> FloatArray:
        """Return the force in N with which it resists, for elongations in m at a speed in m/s."""
        x, v = np.asarray(elongation, dtype=np.float64), finite("speed", speed)
        bent = np.hypot(1.0, self.first_stiffness * x / self.threshold)
        spring = self.second_stiffness + (self.first_stiffness - self.second_stiffness) / bent
        power = v / (v * v + self.rest_speed**2) ** (0.5 * (1.0 - self.exponent))
        damper = np.abs(x / self.stroke) ** self.exponent * power
        return np.asarray(spring * x + self.damping * damper)

    @property
    def steepest(self) -> float:
        """The largest slope in N/m that its force can have, that of small elongations."""
        return self.first_stiffness

    def static_force(self, place: float) -> tuple[float, float]:
        """Return the force in N on the structure, ``place`` m along, at rest, and its slope."""
        bent = float(np.hypot(1.0, self.first_stiffness * place / self.threshold))
        slope = (self.first_stiffness - self.second_stiffness) / bent**3
        return -float(self.force([place])[0]), -(self.second_stiffness + slope)

    def core(self, basis: ModalBasis) -> _core.SeismicDevice:
        """Return the device as the core sees it; see `row`."""
        from bumpstop import _core

        return _core.SeismicDevice(
            self.row(basis),
            self.first_stiffness,
            self.second_stiffness,
            self.threshold,
            self.damping,
            self.exponent,
            self.stroke,
            self.rest_speed,
        )
