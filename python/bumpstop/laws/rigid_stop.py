"""RigidStop: an obstacle that does not give way."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, Vector, finite, not_negative
from bumpstop.errors import InputError
from bumpstop.laws.contact import Contact
from bumpstop.laws.coordinate import Terms

if TYPE_CHECKING:
    from bumpstop import _core
    from bumpstop.modal.basis import ModalBasis

__all__ = ["RigidStop"]

FINEST = 1e-13
"""Finest resolution: heights below it are rounding."""

ROUNDING = 1e-14
"""Part of the terms that a distance is summed of below which it is zero."""


@dataclass(frozen=True)
class RigidStop(Contact):
    """A stop without give: the structure rebounds with a coefficient of restitution.

    The distance ``d = gap + normal . (u - u_other)`` never becomes negative. At an impact its
    rate turns from ``d'`` to ``-restitution d'``; rebounds that become too low to be told from
    nothing end in rest, until a load lifts the structure off. The exact method and
    ``moreau_jean`` take it; with friction, Coulomb's between the impulses along the obstacle and
    its normal, ``moreau_jean`` alone does.

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
    restitution
        Part of the speed that is given back, from 0 to 1.
    obstacle
        Shape of the obstacle: ``"plane"``.
    resolution
        Rebounds lower than this part of the motion, as the largest sum of the sizes of the terms
        of the distance, are not followed: the structure comes to rest. From 1e-13 to 1.
    motion
        Refused: rigid stops do not move.
    friction
        Coefficient of friction along the obstacle; it does not rub where left out.
    sliding
        Direction along the obstacle in which it rubs, or weights of dofs as in ``terms``; may be
        left out where the modes move the node in one direction only along the obstacle.

    Raises
    ------
    InputError
        If a number is out of its range, the normal has no length, the obstacle is unknown, or a
        motion is given, or a sliding direction without friction or that does not lie along the
        obstacle.

    References
    ----------
    J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics, in
    *Nonsmooth Mechanics and Applications*, CISM 302, Springer, 1988.

    Examples
    --------
    A ball falls 1 m and bounces; it lies still after sqrt(2 h / g) (1 + e) / (1 - e).

    >>> import bumpstop as bs
    >>> basis = bs.ModalBasis.from_modes(frequency=[0], damping=[0], shapes={("P", "dz"): [1]})
    >>> floor = bs.RigidStop("floor", node="P", normal=(0, 0, 1), gap=1.0, restitution=0.5)
    >>> weight = bs.NodalForce("weight", node="P", force=(0, 0, -9.81))
    >>> problem = bs.Problem(basis, laws=[floor], loads=[weight], duration=2.0)
    >>> print(f"{bs.simulate(problem).impact_table()['start'][-1]:.4f}")
    1.3546
    """

    _: KW_ONLY
    restitution: float
    resolution: float = 1e-12
    motion: None = None
    friction: float | None = None
    sliding: Vector | Terms | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.motion is not None:
            what, hint = "rigid stops do not move", "a Stop with a stiffness does"
            raise InputError(what, key="motion", value=self.motion, hint=hint)
        restitution = finite("restitution", self.restitution)
        if not 0.0 <= restitution <= 1.0:
            raise InputError("must be from 0 to 1", key="restitution", value=self.restitution)
        object.__setattr__(self, "restitution", restitution)
        resolution = finite("resolution", self.resolution)
        if not FINEST <= resolution <= 1.0:
            what = f"must be from {FINEST:g} to 1"
            hint = "finer ones are lost in rounding"
            raise InputError(what, key="resolution", value=self.resolution, hint=hint)
        object.__setattr__(self, "resolution", resolution)
        self._check_friction()

    def _check_friction(self) -> None:
        if self.friction is None:
            if self.sliding is not None:
                hint = "give the coefficient, friction = 0.2"
                what = "belongs to friction"
                raise InputError(what, key="sliding", value=self.sliding, hint=hint)
            return
        from bumpstop.laws.friction import checked_sliding

        object.__setattr__(self, "friction", not_negative("friction", self.friction))
        sliding = checked_sliding(self.coordinate, self.sliding)
        object.__setattr__(self, "sliding", sliding)

    def sliding_row(self, basis: ModalBasis) -> FloatArray | None:
        """Return the motion along the obstacle, (N,); None without friction.

        Raises
        ------
        InputError
            If no mode moves the node along the obstacle, or in more than one direction and
            none is given.
        """
        if self.friction is None:
            return None
        from bumpstop.laws.friction import sliding_row

        return sliding_row(basis, self.coordinate, self.sliding)

    def check_start(self, basis: ModalBasis, displacement: FloatArray) -> None:
        """Refuse a start, at modal displacements (N,), inside the stop.

        Raises
        ------
        InputError
            If the structure is beyond the obstacle by more than rounding.
        """
        terms = self.row(basis) * displacement
        distance = self.gap + float(terms.sum())
        if distance < -ROUNDING * (abs(self.gap) + float(np.abs(terms).sum())):
            what = f"the structure starts {-distance:.3g} m inside this rigid stop"
            raise InputError(what, key=f"stops.{self.name}.gap", value=self.gap)

    def core(self, basis: ModalBasis) -> _core.RigidStop:
        """Return the stop as the core sees it; see `row`."""
        from bumpstop import _core

        return _core.RigidStop(
            self.row(basis),
            self.gap,
            self.restitution,
            self.resolution,
            self.sliding_row(basis),
            self.friction or 0.0,
        )
