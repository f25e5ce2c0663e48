"""Cross sections of beams: what the elements need to know of a shape."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

from bumpstop.arguments import pair, positive

__all__ = ["Rectangle", "Section"]


@runtime_checkable
class Section(Protocol):
    """A cross section in the beam's local y and z axes, both principal."""

    @property
    def area(self) -> float:
        """Area in m2."""

    @property
    def inertia_y(self) -> float:
        """Second moment of area about local y, the integral of z2, in m4."""

    @property
    def inertia_z(self) -> float:
        """Second moment of area about local z, the integral of y2, in m4."""

    @property
    def torsion_constant(self) -> float:
        """Saint-Venant torsion constant in m4."""

    @property
    def shear_factors(self) -> tuple[float, float]:
        """Shares of the area that carry shear along local y and along local z."""

    def contains(self, y: float, z: float) -> bool:
        """Tell whether the fibre (y, z), in m from the centroid, is in the section."""


@dataclass(frozen=True, kw_only=True)
class Rectangle:
    """A solid rectangle.

    Parameters
    ----------
    height
        Side along the beam's local y, in m.
    width
        Side along the beam's local z, in m.
    shear_factors
        Shares of the area that carry shear along local y and along local z.

    Raises
    ------
    InputError
        If a value is not a finite positive number.

    Examples
    --------
    >>> bar = Rectangle(height=0.02, width=0.01)
    >>> f"{bar.area:.4g} {bar.inertia_y:.4g} {bar.inertia_z:.4g} {bar.torsion_constant:.4g}"
    '0.0002 1.667e-09 6.667e-09 4.574e-09'
    """

    height: float
    width: float
    shear_factors: tuple[float, float] = (5.0 / 6.0, 5.0 / 6.0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "height", positive("height", self.height))
        object.__setattr__(self, "width", positive("width", self.width))
        for factor in pair("shear_factors", self.shear_factors):
            positive("shear_factors", factor)
        object.__setattr__(self, "shear_factors", pair("shear_factors", self.shear_factors))

    @property
    def area(self) -> float:
        """Area in m2."""
        return self.height * self.width

    @property
    def inertia_y(self) -> float:
        """Second moment of area about local y, in m4."""
        return self.height * self.width**3 / 12.0

    @property
    def inertia_z(self) -> float:
        """Second moment of area about local z, in m4."""
        return self.width * self.height**3 / 12.0

    @property
    def torsion_constant(self) -> float:
        """Saint-Venant torsion constant in m4.

        With a the longer and b the shorter side,
        J = a b3 [1/3 - 64 b / (pi5 a) sum over odd n of tanh(n pi a / 2b) / n5]
        (Timoshenko and Goodier, Theory of Elasticity, section 109).
        """
        short, long = sorted((self.height, self.width))
        return (
            long * short**3 * (1.0 / 3.0 - 64.0 / math.pi**5 * short / long * _series(long / short))
        )

    def contains(self, y: float, z: float) -> bool:
        """Tell whether the fibre (y, z), in m from the centroid, is in the section."""
        half = 0.5 * (1.0 + 1e-9)
        return abs(y) <= half * self.height and abs(z) <= half * self.width


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
