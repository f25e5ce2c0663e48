"""Tubes: circular rings."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from bumpstop.arguments import positive
from bumpstop.errors import InputError
from bumpstop.structure.sections.section import EDGE, Section, shear_factor_pair

__all__ = ["Tube"]


@dataclass(frozen=True, kw_only=True)
class Tube(Section):
    """A circular tube.

    Parameters
    ----------
    outer_radius
        Outer radius in m.
    thickness
        Thickness of the wall in m, less than the radius.
    shear_factors
        Shares of the area that carry shear along local y and along local z. Where left out,
        Cowper's for a Poisson's ratio of 0: 1/2 for a thin wall.

    Raises
    ------
    InputError
        If a value is not a finite positive number, or the wall is thicker than the radius.

    Examples
    --------
    >>> tube = Tube(outer_radius=0.011, thickness=0.001)
    >>> f"{tube.area:.4g} {tube.inertia_y:.4g} {tube.shear_factors[0]:.3f}"
    '6.597e-05 3.645e-09 0.502'
    """

    outer_radius: float
    thickness: float
    shear_factors: tuple[float, float] = None  # type: ignore[assignment]  # set when made

    def __post_init__(self) -> None:
        object.__setattr__(self, "outer_radius", positive("outer_radius", self.outer_radius))
        object.__setattr__(self, "thickness", positive("thickness", self.thickness))
        if self.thickness >= self.outer_radius:
            what, hint = "the wall fills the tube", 'take shape "circle" for a solid one'
            raise InputError(what, key="thickness", value=self.thickness, hint=hint)
        factors = self._cowper(0.0) if self.shear_factors is None else self.shear_factors
        object.__setattr__(self, "shear_factors", shear_factor_pair(factors))

    def cowper(self, poisson_ratio: float) -> Tube:
        """Return the same section with Cowper's shear factor for a Poisson's ratio.

        6 (1 + nu) (1 + m2)2 / [(7 + 6 nu) (1 + m2)2 + (20 + 12 nu) m2], m the inner over the
        outer radius (G. R. Cowper, Journal of Applied Mechanics 33 (1966) 335-340).
        """
        return replace(self, shear_factors=self._cowper(poisson_ratio))

    @property
    def inner_radius(self) -> float:
        """Inner radius in m."""
        return self.outer_radius - self.thickness

    @property
    def area(self) -> float:
        """Area in m2."""
        return math.pi * self.thickness * (self.outer_radius + self.inner_radius)

    @property
    def inertia_y(self) -> float:
        """Second moment of area about local y, in m4."""
        return self.area * (self.outer_radius**2 + self.inner_radius**2) / 4.0

    @property
    def inertia_z(self) -> float:
        """Second moment of area about local z, in m4."""
        return self.inertia_y

    @property
    def torsion_constant(self) -> float:
        """Saint-Venant torsion constant in m4."""
        return 2.0 * self.inertia_y

    @property
    def shear_center(self) -> tuple[float, float]:
        """Place of the shear centre from the centroid, in m: it is the centroid."""
        return (0.0, 0.0)

    def contains(self, y: float, z: float) -> bool:
        """Tell whether the fibre (y, z), in m from the centroid, is in the wall."""
        radius = math.hypot(y, z)
        return self.inner_radius <= EDGE * radius and radius <= EDGE * self.outer_radius

    def _cowper(self, nu: float) -> tuple[float, float]:
        ratio2 = (self.inner_radius / self.outer_radius) ** 2
        bore = (1.0 + ratio2) ** 2
        factor = 6.0 * (1.0 + nu) * bore / ((7.0 + 6.0 * nu) * bore + (20.0 + 12.0 * nu) * ratio2)
        return factor, factor
