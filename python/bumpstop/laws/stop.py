"""Stop: unilateral contact of a node with an obstacle."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING, ClassVar

from bumpstop.arguments import FloatArray, Vector, name, not_negative, one_of, positive
from bumpstop.errors import InputError
from bumpstop.laws.obstacle import Plane
from bumpstop.projection import direction_row

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis

__all__ = ["Stop"]

OBSTACLES = ("plane",)


@dataclass(frozen=True)
class Stop:
    """A spring and damper that push a node back once it has crossed the gap.

    With the distance ``d = gap + normal . u`` of the node's displacement u, the stop pushes
    along its normal with ``F = max(0, -stiffness d - damping d')`` while d < 0, and not at
    all while d > 0. It never pulls: with damping the force vanishes before the gap opens.

    Parameters
    ----------
    name
        What the stop is called in results.
    node
        The node that it stops: a node's name or a point along a beam (``"AB@0.462"``).
    normal
        Direction along which the obstacle pushes the structure, in global axes; any length
        but zero, kept as a unit vector.
    gap
        Distance in m to the obstacle where the structure is undeformed; a negative gap is a
        stop that presses already.
    stiffness
        Contact stiffness in N/m, positive.
    damping
        Contact damping in N s/m.
    obstacle
        Shape of the obstacle: ``"plane"``.

    Raises
    ------
    InputError
        If a number is out of its range, the normal has no length, or the obstacle is unknown.

    References
    ----------
    W. Goldsmith, *Impact*, Arnold, 1960 (the spring and damper are Kelvin-Voigt's).

    Examples
    --------
    >>> Stop("guide", node="P", normal=(-2, 0, 0), gap=1e-3, stiffness=1e6).normal
    (-1.0, 0.0, 0.0)
    """

    table: ClassVar[str] = "stops"
    """Where a problem keeps it, in words for messages."""

    name: str
    _: KW_ONLY
    node: str
    normal: Vector
    gap: float = 0.0
    stiffness: float
    damping: float = 0.0
    obstacle: str = "plane"

    def __post_init__(self) -> None:
        name("name", self.name)
        name("node", self.node)
        one_of("obstacle", self.obstacle, OBSTACLES)
        plane = Plane(self.normal, self.gap)
        object.__setattr__(self, "normal", plane.normal)
        object.__setattr__(self, "gap", plane.gap)
        object.__setattr__(self, "stiffness", positive("stiffness", self.stiffness))
        object.__setattr__(self, "damping", not_negative("damping", self.damping))

    def row(self, basis: ModalBasis) -> FloatArray:
        """Return ``normal . shapes`` (N,): distance per unit of each modal displacement.

        Raises
        ------
        InputError
            If the basis has no shape at the node, or none that moves it along the normal.
        """
        row = direction_row(basis, self.node, self.normal)
        if not row.any():
            raise InputError(
                "no mode moves this node along the normal", key="node", value=self.node
            )
        return row
