"""Finite elements: one file an element, pure functions of length and what a slice weighs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from bumpstop.arguments import FloatArray
from bumpstop.structure.elements import bar, prismatic
from bumpstop.structure.elements.prismatic import Numbers
from bumpstop.structure.elements.slice import Slice, slice_of
from bumpstop.structure.material import Material
from bumpstop.structure.sections.section import Section

__all__ = ["THEORIES", "BeamTheory", "Element", "Slice"]


class Element(Protocol):
    """What a two-node, 12-dof element must offer; its module is the implementation.

    Matrices are in the element's local axes, x from the first node to the second, with the
    dofs ``dx dy dz drx dry drz`` of the first node and then of the second. Of arrays, one
    number an element, come arrays of matrices.
    """

    def stiffness(self, length: Numbers, part: Slice, /) -> FloatArray:
        """Return the stiffness matrix (12, 12)."""

    def mass(self, length: Numbers, part: Slice, /) -> FloatArray:
        """Return the consistent mass matrix (12, 12)."""

    def lumped_mass(self, length: Numbers, part: Slice, /) -> FloatArray:
        """Return a diagonal mass matrix (12, 12)."""

    def geometric_stiffness(self, length: Numbers, part: Slice, tension: Numbers, /) -> FloatArray:
        """Return what an axial force adds to the stiffness, (12, 12)."""

    def gyroscopic(self, length: Numbers, part: Slice, spin: Numbers, /) -> FloatArray:
        """Return the gyroscopic matrix (12, 12) of a spin about local x."""

    def interpolation(self, xi: float, length: float, part: Slice, /) -> FloatArray:
        """Return the six displacements at ``xi`` in [0, 1] by the dofs, (6, 12)."""

    def axial_strain(
        self, xi: float, fibre: tuple[float, float], length: float, part: Slice, /
    ) -> FloatArray:
        """Return the axial strain of a fibre (y, z) at ``xi`` by the dofs, (12,)."""


@dataclass(frozen=True)
class BeamTheory:
    """What of a beam's motion counts.

    Parameters
    ----------
    element
        The element of constant section.
    shear
        Whether shear strains it.
    rotary
        Whether its sections have rotary inertia in bending.
    bends
        Whether it resists bending and twist.
    """

    element: Element
    shear: bool = False
    rotary: bool = False
    bends: bool = True

    def slice_of(self, material: Material, section: Section, added_mass: float) -> Slice:
        """Return what a slice resists and weighs."""
        return slice_of(
            material, section, shear=self.shear, rotary=self.rotary, added_mass=added_mass
        )


THEORIES = {
    "timoshenko": BeamTheory(prismatic, shear=True, rotary=True),
    "rayleigh": BeamTheory(prismatic, rotary=True),
    "euler_bernoulli": BeamTheory(prismatic),
    "bar": BeamTheory(bar, bends=False),
}
"""The theories by the names that users write."""
