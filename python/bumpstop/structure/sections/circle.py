"""Solid circles."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from bumpstop.arguments import positive
from bumpstop.structure.sections.section import EDGE, Section, shear_factor_pair

__all__ = ["Circle"]


@dataclass(frozen=True, kw_only=True)
class Circle(Section):
    """A solid circle.

    Parameters
    ----------
    radius
        Radius in m.
    shear_factors
        Shares of the area that carry shear along local y and along local z. Where left out,
        Cowper's for a Poisson's ratio of 0: 6/7.

    Raises
    ------
    InputError
        If a value is not a finite positive number.

    Examples
    --------
    >>> shaft = Circle(radius=0.02)
    >>> f"{shaft.area:.4g} {shaft.inertia_y:.4g} {shaft.torsion_constant:.4g}"
    '0.001257 1.257e-07 2.513e-07'
    """

    radius: float
    shear_factors: tuple[float, float] = (6.0 / 7.0, 6.0 / 7.0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "radius", positive("radius", self.radius))
        object.__setattr__(self, "shear_factors", shear_factor_pair(self.shear_factors))

    def cowper(self, poisson_ratio: float) -> Circle:
        """Return the same section with Cowper's shear factor, 6 (1 + nu) / (7 + 6 nu).

        G. R. Cowper, Journal of Applied Mechanics 33 (1966) 335-340.
        """
        factor = 6.0 * (1.0 + poisson_ratio) / (7.0 + 6.0 * poisson_ratio)
        return replace(self, shear_factors=(factor, factor))

    @property
    def area(self) -> float:
        """Area in m2."""
        return math.pi * self.radius**2

    @property
    def inertia_y(self) -> float:
        """Second moment of area about local y, in m4."""
        return math.pi * self.radius**4 / 4.0

    @property
    def inertia_z(self) -> float:
        """Second moment of area about local z, in m4."""
        return self.inertia_y

    @property
    def torsion_constant(self) -> float:
        """Saint-Venant torsion constant in m4."""
        return math.pi * self.radius**4 / 2.0

    @property
    def shear_center(self) -> tuple[float, float]:
        """Place of the shear centre from the centroid, in m: it is the centroid."""
        return (0.0, 0.0)

    def contains(self, y: float, z: float) -> bool:
        """Tell whether the fibre (y, z), in m from the centroid, is in the section."""
        return math.hypot(y, z) <= EDGE * self.radius
