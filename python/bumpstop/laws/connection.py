"""What laws that hold a node have: a deformation."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

from bumpstop.arguments import FloatArray, Vector, name
from bumpstop.errors import InputError
from bumpstop.laws.coordinate import Coordinate, Terms

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis

__all__ = ["Connection"]


@dataclass(frozen=True)
class Connection:
    """A law along the deformation ``direction . (u - u_other)``, or along a sum of dofs.

    Each kind says in its own words what these are.
    """

    table: ClassVar[str] = "laws"
    """Where a problem keeps it, in words for messages."""
    kind: ClassVar[str]
    """What it is, in words for messages."""

    name: str
    _: KW_ONLY
    node: str | None = None
    direction: Vector | None = None
    other: str | None = None
    terms: Terms | None = None

    def __post_init__(self) -> None:
        name("name", self.name)
        if self.coordinate.terms is None:
            object.__setattr__(self, "direction", self.coordinate.direction)
        object.__setattr__(self, "terms", self.coordinate.terms)

    @cached_property
    def coordinate(self) -> Coordinate:
        """The coordinate of its deformation."""
        return Coordinate.of(self.node, "direction", self.direction, self.other, self.terms)

    def row(self, basis: ModalBasis) -> FloatArray:
        """Return the deformation per unit of each modal displacement, (N,).

        Raises
        ------
        InputError
            If the basis has no shape at a node, or no mode deforms it.
        """
        row = self.coordinate.row(basis)
        if not row.any():
            raise InputError(f"no mode deforms this {self.kind}", key="node", value=self.node)
        return row
