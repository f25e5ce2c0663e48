"""Finite elements: one file an element, pure functions of length, material and section."""

from __future__ import annotations

from typing import Protocol

from bumpstop.arguments import FloatArray
from bumpstop.structure.elements import timoshenko
from bumpstop.structure.material import Material
from bumpstop.structure.section import Section

__all__ = ["THEORIES", "BeamTheory"]


class BeamTheory(Protocol):
    """What a two-node, 12-dof beam element must offer; its module is the implementation.

    Matrices are in the element's local axes, x from the first node to the second, with the
    dofs ``dx dy dz drx dry drz`` of the first node and then of the second.
    """

    def stiffness(self, length: float, material: Material, section: Section) -> FloatArray:
        """Return the stiffness matrix (12, 12)."""

    def mass(self, length: float, material: Material, section: Section) -> FloatArray:
        """Return the consistent mass matrix (12, 12)."""

    def interpolation(
        self, xi: float, length: float, material: Material, section: Section
    ) -> FloatArray:
        """Return the six displacements at ``xi`` in [0, 1] by the dofs, (6, 12)."""

    def axial_strain(
        self,
        xi: float,
        fibre: tuple[float, float],
        length: float,
        material: Material,
        section: Section,
    ) -> FloatArray:
        """Return the axial strain of a fibre (y, z) at ``xi`` by the dofs, (12,)."""


THEORIES: dict[str, BeamTheory] = {"timoshenko": timoshenko}
"""The beam theories by the names that users write."""
