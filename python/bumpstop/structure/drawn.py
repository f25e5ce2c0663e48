"""What a model tells of itself so that it can be drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple, Protocol, runtime_checkable

from bumpstop.arguments import Vector
from bumpstop.structure.support import Support

__all__ = ["DrawnModel", "Line"]


class Line(NamedTuple):
    """A beam as it is drawn: points along it are called ``name@distance``."""

    name: str
    length: float
    """In m."""
    elements: int


@runtime_checkable
class DrawnModel(Protocol):
    """A model that knows places and lines."""

    @property
    def nodes(self) -> Mapping[str, Sequence[float]]:
        """Coordinates of the nodes that its user named, in m."""

    @property
    def lines(self) -> Sequence[Line]:
        """Its beams."""

    @property
    def supports(self) -> Sequence[Support]:
        """What it is held by."""

    def position(self, node: str) -> Vector:
        """Return where a node, or a point along a beam, is at rest, in m."""
