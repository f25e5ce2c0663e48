"""Rectangles, solid or hollow."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from bumpstop.arguments import positive
from bumpstop.errors import InputError
from bumpstop.structure.sections.section import EDGE, Section, shear_factor_pair

__all__ = ["Rectangle"]


@dataclass(frozen=True, kw_only=True)
class Rectangle(Section):
    """A rectangle, solid or with a wall of even thickness.

    Parameters
    ----------
    height
        Side along the beam's local y, in m.
    width
        Side along the beam's local z, in m.
    thickness
        Thickness of the wall of a hollow rectangle, in m; solid where left out.
    shear_factors
        Shares of the area that carry shear along local y and along local z. Where left out,
        those of Cowper for a Poisson's ratio of 0: 5/6 for a solid rectangle.

    Raises
    ------
    InputError
        If a value is not a finite positive number, or the walls are thicker than the section.

    Examples
    --------
    >>> bar = Rectangle(height=0.02, width=0.01)
    >>> f"{bar.area:.4g} {bar.inertia_y:.4g} {bar.inertia_z:.4g} {bar.torsion_constant:.4g}"
    '0.0002 1.667e-09 6.667e-09 4.574e-09'
    >>> round(Rectangle(height=0.06, width=0.04, thickness=0.003).area * 1e4, 2)
    5.64
    """

    height: float
    width: float
    thickness: float | None = None
    shear_factors: tuple[float, float] = None  # type: ignore[assignment]  # set when made

    def __post_init__(self) -> None:
        object.__setattr__(self, "height", positive("height", self.height))
        object.__setattr__(self, "width", positive("width", self.width))
        if self.thickness is not None:
            object.__setattr__(self, "thickness", self._wall(self.thickness))
        factors = self._cowper(0.0) if self.shear_factors is None else self.shear_factors
        object.__setattr__(self, "shear_factors", shear_factor_pair(factors))

    def cowper(self, poisson_ratio: float) -> Rectangle:
        """Return the same section with Cowper's shear factors for a Poisson's ratio.

        Solid: 10 (1 + nu) / (12 + 11 nu). Hollow: that of a thin-walled box
        (G. R. Cowper, Journal of Applied Mechanics 33 (1966) 335-340).
        """
        return replace(self, shear_factors=self._cowper(poisson_ratio))

    @property
    def area(self) -> float:
        """Area in m2."""
        height, width = self._hole
        return self.height * self.width - height * width

    @property
    def inertia_y(self) -> float:
        """Second moment of area about local y, in m4."""
        height, width = self._hole
        return self.height * self.width**3 / 12.0 - height * width**3 / 12.0

    @property
    def inertia_z(self) -> float:
        """Second moment of area about local z, in m4."""
        height, width = self._hole
        return self.width * self.height**3 / 12.0 - width * height**3 / 12.0

    @property
    def torsion_constant(self) -> float:
        """Saint-Venant torsion constant in m4.

        Solid, with a the longer and b the shorter side:
        J = a b3 [1/3 - 64 b / (pi5 a) sum over odd n of tanh(n pi a / 2b) / n5]
        (Timoshenko and Goodier, Theory of Elasticity, section 109).
        Hollow, with a and b along the middle of the walls of thickness t:
        J = 2 t a2 b2 / (a + b), Bredt's formula for thin walls.
        """
        if self.thickness is not None:
            a, b = self.height - self.thickness, self.width - self.thickness
            return 2.0 * self.thickness * a**2 * b**2 / (a + b)
        short, long = sorted((self.height, self.width))
        return (
            long * short**3 * (1.0 / 3.0 - 64.0 / math.pi**5 * short / long * _series(long / short))
        )

    @property
    def shear_center(self) -> tuple[float, float]:
        """Place of the shear centre from the centroid, in m: it is the centroid."""
        return (0.0, 0.0)

    def contains(self, y: float, z: float) -> bool:
        """Tell whether the fibre (y, z), in m from the centroid, is in the section."""
        inside = 2.0 * abs(y) <= EDGE * self.height and 2.0 * abs(z) <= EDGE * self.width
        height, width = self._hole
        hole = 2.0 * abs(y) * EDGE < height and 2.0 * abs(z) * EDGE < width
        return inside and not hole

    @property
    def _hole(self) -> tuple[float, float]:
        """Height and width of the hole; zero for a solid section."""
        if self.thickness is None:
            return 0.0, 0.0
        return self.height - 2.0 * self.thickness, self.width - 2.0 * self.thickness

    def _wall(self, thickness: object) -> float:
        wall = positive("thickness", thickness)
        if 2.0 * wall >= min(self.height, self.width):
            what, hint = "the walls fill the section", "leave thickness out for a solid one"
            raise InputError(what, key="thickness", value=thickness, hint=hint)
        return wall

    def _cowper(self, nu: float) -> tuple[float, float]:
        if self.thickness is None:
            factor = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu)
            return factor, factor
        a, b = self.height - self.thickness, self.width - self.thickness
        return _box_factor(a, b, nu), _box_factor(b, a, nu)


def _box_factor(along: float, across: float, nu: float) -> float:
    """Return Cowper's factor of a thin-walled box, for shear along its side ``along``."""
    m = across / along
    webs = 12.0 + 72.0 * m + 150.0 * m**2 + 90.0 * m**3
    poisson = nu * (11.0 + 66.0 * m + 135.0 * m**2 + 90.0 * m**3)
    flanges = 10.0 * m**2 * ((3.0 + nu) * m + 3.0 * m**2)
    return 10.0 * (1.0 + nu) * (1.0 + 3.0 * m) ** 2 / (webs + poisson + flanges)


def _series(aspect: float) -> float:
    """Sum over odd n of tanh(n pi aspect / 2) / n5, for an aspect ratio of 1 or more.

    The sum of 1 / n5 is known, 31/32 zeta(5); what tanh lacks of 1 dies out so fast
    that thirteen terms leave less than rounding.
    """
    zeta_5 = 1.0369277551433699
    lacking = (
        2.0 / (math.exp(min(n * math.pi * aspect, 700.0)) + 1.0) / n**5 for n in range(1, 27, 2)
    )
    return 31.0 / 32.0 * zeta_5 - sum(lacking)
