"""PlaneStop: unilateral contact with a plane that rubs in every direction along it."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from bumpstop.arguments import FloatArray, Vector, finite
from bumpstop.errors import InputError
from bumpstop.laws.coordinate import unit
from bumpstop.laws.shaped_stop import ShapedStop

if TYPE_CHECKING:
    from bumpstop import _core
    from bumpstop.modal.basis import ModalBasis

__all__ = ["PlaneStop"]


@dataclass(frozen=True)
class PlaneStop(ShapedStop):
    """A plane obstacle along which the structure rubs in both directions.

    Normal to the plane it is a `Stop`, with the distance ``d = gap + normal . (u - u_other)`` and
    ``F = max(0, -stiffness d - damping d')`` while d < 0. Along it friction acts as in a
    `CircleStop`: a spring and a damper side by side, and a slider behind them that holds up to
    ``static F`` whatever the direction. The adaptive methods take it; friction in one direction,
    that of a `Stop`, is solved exactly.

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
    gap
        Distance in m to the obstacle where the structure is undeformed.
    stiffness
        Contact stiffness in N/m, positive.
    damping
        Contact damping in N s/m.
    friction
        Coefficient of friction, or ``{"static": ..., "dynamic": ...}``.
    tangential_stiffness
        Stiffness in N/m of a contact that sticks.
    tangential_damping
        Damping in N s/m of a contact that sticks, positive; where left out critical damping of
        the sticking contact, see `stick_damping`.
    motion
        How the obstacle moves: for some of ``"dx"``, ``"dy"`` and ``"dz"`` the functions of time
        whose sum moves it along that global axis, in m.
    frame
        ``"relative"`` to supports that move, which then carry the obstacle, or ``"absolute"``: it
        stands still on the ground.

    Raises
    ------
    InputError
        If a number is out of its range, the normal has no length, or there is no friction.

    Examples
    --------
    A block that is thrown askew over a floor slides straight on, for v^2 / (2 mu g).

    >>> import bumpstop as bs
    >>> shapes = {("P", dof): row for dof, row in zip(("dx", "dy", "dz"), [[1, 0, 0], [0, 1, 0],
    ...           [0, 0, 1]])}
    >>> block = bs.ModalBasis.from_modes(frequency=[0] * 3, damping=[0] * 3, shapes=shapes)
    >>> floor = bs.PlaneStop("floor", node="P", normal=(0, 0, 1), gap=-1e-4, stiffness=1e5,
    ...                      friction=0.5, tangential_stiffness=1e6)
    >>> weight = bs.NodalForce("weight", node="P", force=(0, 0, -10.0))
    >>> thrown = bs.ModalState(velocity=[3.0, 4.0, 0.0])
    >>> run = bs.simulate(bs.Problem(block, laws=[floor], loads=[weight], initial=thrown,
    ...                              duration=1.2))
    >>> x, y = (run.sample("displacement", "P", dof, times=[1.2])[0] for dof in ("dx", "dy"))
    >>> f"{x:.3f} m, {y:.3f} m"
    '1.500 m, 2.000 m'
    """

    smooth: ClassVar[str] = "it rubs in two directions"
    obstacle: ClassVar[str] = "plane"

    _: KW_ONLY
    normal: Vector
    gap: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "normal", unit("normal", self.normal))
        object.__setattr__(self, "gap", finite("gap", self.gap))
        super().__post_init__()
        if self.friction is None:
            hint = "without friction take a Stop, which is solved exactly"
            raise InputError("is what this stop is for", key="friction", hint=hint)

    @cached_property
    def axes(self) -> FloatArray:
        """The normal and two directions along the plane, one a row, (3, 3).

        The second is the part along the plane of the global axis that the normal is least along.
        """
        normal = np.array(self.normal)
        along = np.eye(3)[int(np.argmin(np.abs(normal)))]
        along = along - (along @ normal) * normal
        along /= np.linalg.norm(along)
        return np.array([normal, along, np.cross(normal, along)])

    def origin(self, basis: ModalBasis) -> FloatArray:  # noqa: ARG002  # others ask it
        """Return where the node at rest stands: the gap says all, (2,), in m."""
        return np.zeros(2)

    def shape(self) -> _core.Shape:
        """Return the obstacle as the core sees it."""
        from bumpstop import _core

        return _core.Shape.plane(self.gap)

    def distances(self, places: FloatArray) -> FloatArray:
        """Return the distances of places along normal and plane, (n, 2), in m."""
        return np.asarray(self.gap + places[:, 0])

    def normals(self, places: FloatArray) -> FloatArray:
        """Return the normal at places, (n, 2)."""
        return np.tile([1.0, 0.0], (len(places), 1))
