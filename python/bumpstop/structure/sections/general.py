"""Sections of any shape, by their numbers."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from bumpstop.arguments import pair, positive
from bumpstop.errors import InputError
from bumpstop.structure.sections.section import EDGE, Section, shear_factor_pair

__all__ = ["GeneralSection"]


@dataclass(frozen=True, kw_only=True)
class GeneralSection(Section):
    """A section of any shape, given by its numbers.

    Local y and z start at the centroid and are the principal axes of the section.

    Parameters
    ----------
    area
        Area in m2.
    inertia_y, inertia_z
        Second moments of area about local y (the integral of z2) and about local z, in m4.
    torsion_constant
        Saint-Venant torsion constant in m4.
    shear_factors
        Shares of the area that carry shear along local y and along local z.
    shear_center
        Place (y, z) of the shear centre from the centroid, in m. Where it is not zero,
        bending and torsion are coupled.
    extent_y, extent_z
        Least and greatest y and z of the section, in m, if gauges are to be checked.

    Raises
    ------
    InputError
        If a value is not finite, or not positive where it must be.

    Examples
    --------
    >>> channel = GeneralSection(
    ...     area=1.35e-3, inertia_y=2.9e-7, inertia_z=2.06e-6, torsion_constant=2.8e-8,
    ...     shear_factors=(0.45, 0.4), shear_center=(0.0, -0.031),
    ... )
    >>> channel.contains(0.0, 1.0)  # nobody said how large it is
    True
    """

    area: float
    inertia_y: float
    inertia_z: float
    torsion_constant: float
    shear_factors: tuple[float, float] = (1.0, 1.0)
    shear_center: tuple[float, float] = (0.0, 0.0)
    extent_y: tuple[float, float] | None = None
    extent_z: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        for key in ("area", "inertia_y", "inertia_z", "torsion_constant"):
            object.__setattr__(self, key, positive(key, getattr(self, key)))
        object.__setattr__(self, "shear_factors", shear_factor_pair(self.shear_factors))
        object.__setattr__(self, "shear_center", pair("shear_center", self.shear_center))
        for key in ("extent_y", "extent_z"):
            if getattr(self, key) is not None:
                object.__setattr__(self, key, _extent(key, getattr(self, key)))

    def contains(self, y: float, z: float) -> bool:
        """Tell whether the fibre (y, z) is within the extents; True where none are given."""
        return _within(y, self.extent_y) and _within(z, self.extent_z)

    def between(self, other: GeneralSection, part: float) -> GeneralSection:
        """Return the section ``part`` of the way to another, as if scaled by its lengths.

        The square root of the area and the fourth roots of the moments change linearly,
        which is exact where the two sections are similar figures.
        """
        plain = super().between(other, part)
        scaled: dict[str, Any] = {
            key: _power_mean(getattr(self, key), getattr(other, key), part, power)
            for key, power in _POWERS.items()
        }
        return replace(plain, **scaled)


_POWERS = {"area": 2, "inertia_y": 4, "inertia_z": 4, "torsion_constant": 4}


def _power_mean(first: float, second: float, part: float, power: int) -> float:
    root = (1.0 - part) * first ** (1.0 / power) + part * second ** (1.0 / power)
    mean: float = root**power
    return mean


def _extent(key: str, value: object) -> tuple[float, float]:
    least, greatest = pair(key, value)
    if not least < 0.0 < greatest:
        what = "must be a negative and a positive number"
        raise InputError(what, key=key, value=value, hint="the centroid is at 0")
    return least, greatest


def _within(place: float, extent: tuple[float, float] | None) -> bool:
    return extent is None or EDGE * extent[0] <= place <= EDGE * extent[1]
