"""The six degrees of freedom of a node, in the order of every matrix."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

__all__ = ["DOFS", "Dof", "Place"]

DOFS = ("dx", "dy", "dz", "drx", "dry", "drz")
"""Displacements in m along, and rotations in rad about, the global axes."""

Dof: TypeAlias = tuple[str, str]
"""A node's name and one of ``DOFS``."""

Place: TypeAlias = tuple[str, str | Sequence[float]]
"""A node and a dof, ``("B", "dy")``, or a node and a direction, ``("B", (0, 0.6, 0.8))``."""
