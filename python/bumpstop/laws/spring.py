"""SpringLaw: an elastic spring whose stiffness changes with its deformation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, ClassVar, Self

import numpy as np

from bumpstop.arguments import FloatArray, Vector, finite, not_negative
from bumpstop.laws.connection import Connection
from bumpstop.laws.coordinate import Terms
from bumpstop.laws.polyline import checked_segments, line_values, slopes_through

if TYPE_CHECKING:
    from bumpstop import _core
    from bumpstop.modal.basis import ModalBasis

__all__ = ["SpringLaw"]


@dataclass(frozen=True)
class SpringLaw(Connection):
    """A bilinear or multilinear elastic spring, with a damper beside it.

    With the deformation ``x = direction . (u - u_other)`` the force on the node is
    ``-(f(x) + damping x')`` along the direction, and the opposite on the other node. f is
    continuous and has one slope in each segment between two breaks; it is ``preload`` at x = 0.
    Loading and unloading follow the same line: nothing but the damper dissipates.

    Parameters
    ----------
    name
        What the spring is called in results.
    node
        The node that it holds: a node's name or a point along a beam (``"AB@0.462"``).
    direction
        Direction along which it acts, in global axes; any length but zero, kept as a unit
        vector.
    other
        The node that holds it; the ground where left out.
    terms
        Instead of node, direction and other: the weight of each (node, dof) in the deformation.
    stiffness
        Slopes in N/m, from the lowest deformations to the highest; one more than breaks. They
        may be zero (play) or negative (buckling).
    breaks
        Deformations in m at which the slope changes, increasing.
    preload
        Force in N that resists at no deformation.
    damping
        Damping constant in N s/m.

    Raises
    ------
    InputError
        If a number is not finite, the breaks do not increase or do not fit the slopes.

    Examples
    --------
    A bilinear spring, harder in compression, and a symmetric one with play of 2 mm:

    >>> pad = SpringLaw("pad", node="P", direction=(0, 0, 1), stiffness=(5e5, 1e5), breaks=(0.0,))
    >>> play = SpringLaw("play", node="P", direction=(1, 0, 0), stiffness=(1e5, 0.0, 1e5),
    ...                  breaks=(-1e-3, 1e-3))
    >>> play.force([-3e-3, 0.0, 2e-3]).tolist()
    [-200.0, 0.0, 100.0]
    """

    kind: ClassVar[str] = "spring"

    _: KW_ONLY
    stiffness: Sequence[float]
    breaks: Sequence[float] = ()
    preload: float = 0.0
    damping: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        stiffness, breaks = checked_segments("stiffness", self.stiffness, self.breaks)
        object.__setattr__(self, "stiffness", stiffness)
        object.__setattr__(self, "breaks", breaks)
        object.__setattr__(self, "preload", finite("preload", self.preload))
        object.__setattr__(self, "damping", not_negative("damping", self.damping))

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
        damping: float = 0.0,
    ) -> Self:
        """Return the spring whose force follows a line through points.

        Parameters
        ----------
        points
            Pairs of deformation in m and resisting force in N, at least two, in the order of
            deformation. Beyond the ends the outermost slopes go on.
        name, node, direction, other, terms, damping
            As for any such spring.

        Examples
        --------
        >>> curve = [(-1e-3, -50.0), (0.0, 0.0), (2e-3, 400.0)]
        >>> SpringLaw.through(curve, "pad", node="P", direction=(1, 0, 0)).stiffness
        (50000.0, 200000.0)
        """
        slopes, breaks, preload = slopes_through(points, "deformation")
        return cls(
            name,
            node=node,
            direction=direction,
            other=other,
            terms=terms,
            stiffness=slopes,
            breaks=breaks,
            preload=preload,
            damping=damping,
        )

    def core(self, basis: ModalBasis) -> _core.Spring:
        """Return the spring as the core sees it; see `row`."""
        from bumpstop import _core

        breaks, stiffness = np.array(self.breaks, np.float64), np.array(self.stiffness)
        return _core.Spring(self.row(basis), breaks, stiffness, self.preload, self.damping)

    @property
    def steepest(self) -> float:
        """The largest slope in N/m that its force can have."""
        return max(abs(slope) for slope in self.stiffness)

    def static_force(self, place: float) -> tuple[float, float]:
        """Return the force in N on the structure, ``place`` m along, at rest, and its slope."""
        segment = int(np.searchsorted(self.breaks, place, side="right"))
        return -float(self.force([place])[0]), -self.stiffness[segment]

    def force(self, deformation: FloatArray | Sequence[float]) -> FloatArray:
        """Return the force in N with which it resists, for deformations in m at rest."""
        return line_values(deformation, self.stiffness, self.breaks, self.preload)
