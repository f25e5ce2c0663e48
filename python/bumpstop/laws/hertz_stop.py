"""HertzStop: unilateral contact whose force is a power of the depth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, ClassVar

from bumpstop.arguments import FloatArray, finite, not_negative, one_of, positive
from bumpstop.errors import InputError
from bumpstop.laws.contact import Contact

if TYPE_CHECKING:
    from bumpstop import _core
    from bumpstop.loads.time import TimeFunction
    from bumpstop.modal.basis import ModalBasis

__all__ = ["HertzStop"]


@dataclass(frozen=True)
class HertzStop(Contact):
    """A stop that pushes with a power of its depth, as elastic bodies do that touch in a point.

    With the distance ``d = gap + normal . (u - u_other)`` and the depth e = -d the stop pushes
    along its normal with ``F = stiffness e^exponent (1 + hunt_crossley e')`` while e > 0 and the
    bracket is positive, and not at all else. The adaptive methods take it.

    Parameters
    ----------
    name
        What the stop is called in results.
    node
        The node that it stops: a node's name or a point along a beam (``"AB@0.462"``).
    normal
        Direction along which the obstacle pushes the structure, in global axes; any length
        but zero, kept as a unit vector.
    other
        A node that carries the obstacle: the stop acts between the two.
    terms
        Instead of node, normal and other: the weight of each (node, dof) in the distance.
    gap
        Distance in m to the obstacle where the structure is undeformed.
    stiffness
        Force in N at a depth of 1 m, positive: its unit is N/m^exponent.
    exponent
        Power of the depth, at least 1; 1.5 for bodies that touch in a point.
    hunt_crossley
        Damping coefficient in s/m of Hunt and Crossley. The coefficient of restitution is about
        ``1 - (2/3) hunt_crossley v`` for slow impacts of speed v with exponent 1.5.
    obstacle
        Shape of the obstacle: ``"plane"``.
    motion
        How far the obstacle moves along its normal, in m over time: a `Harmonic`, a `Polynomial`,
        a `TimeTable` without jumps, another function of time, or a list of them, which add up.
    frame
        Where the obstacle stands while supports move: ``"relative"`` to them, or ``"absolute"``,
        still on the ground.

    Raises
    ------
    InputError
        If a number is out of its range, the normal has no length, or the obstacle is unknown.

    References
    ----------
    H. Hertz, Ueber die Beruehrung fester elastischer Koerper, *J. reine angew. Math.* 92, 1882;
    K. H. Hunt and F. R. E. Crossley, Coefficient of restitution interpreted as damping in
    vibroimpact, *J. Appl. Mech.* 42, 1975.

    Examples
    --------
    A mass of 1 kg arrives with 1 m/s. It goes to a depth of d = (5 m v^2/(4 k))^(2/5), and leaves
    after 2.9433 d/v.

    >>> import bumpstop as bs
    >>> wall = HertzStop("wall", node="P", normal=(1, 0, 0), stiffness=1e9)
    >>> mass = bs.ModalBasis.from_modes(frequency=[0], damping=[0], shapes={("P", "dx"): [1]})
    >>> arriving = bs.ModalState(displacement=[0.0], velocity=[-1.0])
    >>> problem = bs.Problem(mass, laws=[wall], initial=arriving, duration=2e-3)
    >>> response = bs.simulate(problem)
    >>> d = (5 / 4e9) ** 0.4
    >>> duration = response.impact_table()["duration"][0]
    >>> response.method, f"{duration * 1e3:.5f} ms", f"{2.943275 * d * 1e3:.5f} ms"
    ('dop853', '0.80834 ms', '0.80834 ms')
    """

    smooth: ClassVar[str] = "its force is a power of the depth"
    """Why it is not piecewise linear."""

    _: KW_ONLY
    stiffness: float
    exponent: float = 1.5
    hunt_crossley: float = 0.0
    motion: TimeFunction | Sequence[TimeFunction] = ()
    frame: str = "relative"

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "stiffness", positive("stiffness", self.stiffness))
        exponent = finite("exponent", self.exponent)
        if exponent < 1.0:
            hint = "the force of lower powers has no slope that is finite at the first touch"
            raise InputError("must be at least 1", key="exponent", value=self.exponent, hint=hint)
        object.__setattr__(self, "exponent", exponent)
        damping = not_negative("hunt_crossley", self.hunt_crossley)
        object.__setattr__(self, "hunt_crossley", damping)
        one_of("frame", self.frame, ("relative", "absolute"))
        if self.motion != ():
            from bumpstop.loads.time import time_functions

            object.__setattr__(self, "motion", time_functions(self.motion, "motion"))

    @staticmethod
    def sphere(radius: float, young_modulus: float, poisson_ratio: float) -> float:
        """Return the stiffness in N/m^1.5 of a sphere on a half space of the same material.

        ``(4/3) E* sqrt(radius)`` with ``1/E* = 2 (1 - nu^2)/E``. Of two spheres the radius is
        ``r1 r2/(r1 + r2)``.

        Parameters
        ----------
        radius
            In m.
        young_modulus
            E in Pa.
        poisson_ratio
            nu.

        References
        ----------
        K. L. Johnson, *Contact Mechanics*, Cambridge, 1985, section 4.2.

        Examples
        --------
        >>> f"{HertzStop.sphere(radius=0.01, young_modulus=210e9, poisson_ratio=0.3):.4g}"
        '1.538e+10'
        """
        modulus = positive("young_modulus", young_modulus)
        shrink = 1.0 - finite("poisson_ratio", poisson_ratio) ** 2
        return float(4.0 / 3.0 * modulus / (2.0 * shrink) * positive("radius", radius) ** 0.5)

    @property
    def functions(self) -> tuple[TimeFunction, ...]:
        """The functions of time whose sum moves the obstacle."""
        return self.motion  # type: ignore[return-value]  # a tuple once it has been checked

    @property
    def motions(self) -> tuple[tuple[TimeFunction, ...], ...]:
        """The same for each of its coordinates: along the normal alone."""
        return (self.functions,)

    def core(self, basis: ModalBasis) -> _core.HertzStop:
        """Return the stop as the core sees it; see `row`."""
        from bumpstop import _core

        row = self.row(basis)
        return _core.HertzStop(row, self.gap, self.stiffness, self.exponent, self.hunt_crossley)

    def static_force(self, place: float) -> tuple[float, float]:
        """Return the push in N at rest, ``place`` m along the normal, and its slope in N/m."""
        depth = max(0.0, -(self.gap + place))
        slope = self.exponent * self.stiffness * depth ** (self.exponent - 1.0)
        return self.stiffness * depth**self.exponent, -slope if depth > 0.0 else 0.0

    def force(self, depth: FloatArray | Sequence[float], rate: float = 0.0) -> FloatArray:
        """Return the force in N for depths in m, which grow at a rate in m/s."""
        import numpy as np

        depths = np.maximum(np.asarray(depth, dtype=np.float64), 0.0)
        bracket = max(0.0, 1.0 + self.hunt_crossley * rate)
        return np.asarray(self.stiffness * depths**self.exponent * bracket)
