"""DamperLaw: a damper whose constant changes with its speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, ClassVar, Self

import numpy as np

from bumpstop.arguments import FloatArray, Vector, finite
from bumpstop.laws.connection import Connection
from bumpstop.laws.coordinate import Terms
from bumpstop.laws.polyline import checked_segments, line_values, slopes_through

if TYPE_CHECKING:
    from bumpstop import _core
    from bumpstop.modal.basis import ModalBasis

__all__ = ["DamperLaw"]


@dataclass(frozen=True)
class DamperLaw(Connection):
    """A bilinear or multilinear damper: a force that is a table of the speed.

    With the speed ``v = direction . (u' - u_other')`` the force on the node is ``-f(v)`` along
    the direction, and the opposite on the other node. f is continuous and has one slope in each
    segment between two breaks; it is ``offset`` at v = 0. The exact method takes it.

    Parameters
    ----------
    name
        What the damper is called in results.
    node
        The node that it holds: a node's name or a point along a beam (``"AB@0.462"``).
    direction
        Direction along which it acts, in global axes; any length but zero, kept as a unit
        vector.
    other
        The node that holds it; the ground where left out.
    terms
        Instead of node, direction and other: the weight of each (node, dof) in the elongation.
    damping
        Slopes in N s/m, from the lowest speeds to the highest; one more than breaks.
    breaks
        Speeds in m/s at which the slope changes, increasing.
    offset
        Force in N that resists at no speed.

    Raises
    ------
    InputError
        If a number is not finite, the breaks do not increase or do not fit the slopes.

    Examples
    --------
    A damper with a relief valve: beyond 0.2 m/s its force hardly grows.

    >>> valve = DamperLaw("valve", node="P", direction=(1, 0, 0), damping=(50.0, 2e3, 50.0),
    ...                   breaks=(-0.2, 0.2))
    >>> valve.force([-0.2, 0.0, 0.1, 1.2]).tolist()
    [-400.0, 0.0, 200.0, 450.0]
    """

    kind: ClassVar[str] = "damper"

    _: KW_ONLY
    damping: Sequence[float]
    breaks: Sequence[float] = ()
    offset: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        damping, breaks = checked_segments("damping", self.damping, self.breaks)
        object.__setattr__(self, "damping", damping)
        object.__setattr__(self, "breaks", breaks)
        object.__setattr__(self, "offset", finite("offset", self.offset))

    @classmethod
    def through(
        cls,
        points: Sequence[Sequence[float]],
        name: str,
        *,
        node: str | None = None,
        direction: Vector | None = None,
        other: str | None = None,
        terms: Terms | None = None,
    ) -> Self:
        """Return the damper whose force follows a line through points.

        Parameters
        ----------
        points
            Pairs of speed in m/s and resisting force in N, at least two, in the order of speed.
            Beyond the ends the outermost slopes go on.
        name, node, direction, other, terms
            As for any such damper.

        Examples
        --------
        >>> curve = [(-1.0, -50.0), (0.0, 0.0), (2.0, 400.0)]
        >>> DamperLaw.through(curve, "pad", node="P", direction=(1, 0, 0)).damping
        (50.0, 200.0)
        """
        slopes, breaks, offset = slopes_through(points, "speed")
        return cls(
            name,
            node=node,
            direction=direction,
            other=other,
            terms=terms,
            damping=slopes,
            breaks=breaks,
            offset=offset,
        )

    def core(self, basis: ModalBasis) -> _core.Damper:
        """Return the damper as the core sees it; see `row`."""
        from bumpstop import _core

        breaks, damping = np.array(self.breaks, np.float64), np.array(self.damping)
        return _core.Damper(self.row(basis), breaks, damping, self.offset)

    def static_force(self, place: float) -> tuple[float, float]:  # noqa: ARG002  # the same for any
        """Return the force in N on the structure at rest, and its slope, which is zero."""
        return -self.force([0.0]).item(), 0.0

    def force(self, speed: FloatArray | Sequence[float]) -> FloatArray:
        """Return the force in N with which it resists, for speeds in m/s."""
        return line_values(speed, self.damping, self.breaks, self.offset)
