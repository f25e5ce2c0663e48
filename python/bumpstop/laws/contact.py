"""What stops of every kind have: a distance from an obstacle."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

from bumpstop.arguments import FloatArray, Vector, finite, name, one_of
from bumpstop.errors import InputError
from bumpstop.laws.coordinate import Coordinate, Terms

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis

__all__ = ["FRICTION_KEYS", "OBSTACLES", "SLIDING_RULES", "Contact"]

OBSTACLES = ("plane",)
FRICTION_KEYS = ("static", "dynamic", "rule")
"""What friction may be told by name."""
SLIDING_RULES = ("slider", "velocity_sign")
"""What may tell that a contact that slides slides on; see `Friction`."""


@dataclass(frozen=True)
class Contact:
    """A law along the distance of a node, two nodes or a sum of dofs from an obstacle.

    Each kind of stop says in its own words what these are.
    """

    table: ClassVar[str] = "stops"
    """Where a problem keeps it, in words for messages."""

    name: str
    _: KW_ONLY
    node: str | None = None
    normal: Vector | None = None
    other: str | None = None
    terms: Terms | None = None
    gap: float = 0.0
    obstacle: str = "plane"

    def __post_init__(self) -> None:
        name("name", self.name)
        one_of("obstacle", self.obstacle, OBSTACLES)
        object.__setattr__(self, "gap", finite("gap", self.gap))
        if self.coordinate.terms is None:
            object.__setattr__(self, "normal", self.coordinate.direction)
        object.__setattr__(self, "terms", self.coordinate.terms)

    @cached_property
    def coordinate(self) -> Coordinate:
        """The coordinate that its distance is measured along."""
        return Coordinate.of(self.node, "normal", self.normal, self.other, self.terms)

    def row(self, basis: ModalBasis) -> FloatArray:
        """Return the distance per unit of each modal displacement, (N,).

        Raises
        ------
        InputError
            If the basis has no shape at a node, or none that changes the distance.
        """
        along = self.coordinate
        row = along.row(basis)
        if row.any():
            return row
        if along.terms is not None:
            raise InputError("no mode changes this sum", key="terms", value=along.terms)
        moves = "moves this node" if along.other is None else "moves these nodes against each other"
        raise InputError(f"no mode {moves} along the normal", key="node", value=along.node)
