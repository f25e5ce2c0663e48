"""The six degrees of freedom of a node, in the order of every matrix."""

from __future__ import annotations

from typing import TypeAlias

__all__ = ["DOFS", "Dof"]

DOFS = ("dx", "dy", "dz", "drx", "dry", "drz")
"""Displacements in m along, and rotations in rad about, the global axes."""

Dof: TypeAlias = tuple[str, str]
"""A node's name and one of ``DOFS``."""
