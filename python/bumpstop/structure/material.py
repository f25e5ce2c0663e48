"""Linear elastic, isotropic materials."""

from __future__ import annotations

from dataclasses import dataclass

from bumpstop.arguments import finite, positive
from bumpstop.errors import InputError

__all__ = ["Material"]


@dataclass(frozen=True, kw_only=True)
class Material:
    """A linear elastic, isotropic material.

    Parameters
    ----------
    young_modulus
        Young's modulus E in Pa.
    poisson_ratio
        Poisson's ratio, above -1 and at most 0.5.
    density
        Mass density in kg/m3.

    Raises
    ------
    InputError
        If a value is not a finite number within its bounds.

    Examples
    --------
    >>> Material(young_modulus=67e9, poisson_ratio=0.0, density=2400.0).shear_modulus
    33500000000.0
    """

    young_modulus: float
    poisson_ratio: float
    density: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "young_modulus", positive("young_modulus", self.young_modulus))
        object.__setattr__(self, "poisson_ratio", _poisson_ratio(self.poisson_ratio))
        object.__setattr__(self, "density", positive("density", self.density))

    @property
    def shear_modulus(self) -> float:
        """Shear modulus G = E / (2 (1 + nu)) in Pa."""
        return self.young_modulus / (2.0 * (1.0 + self.poisson_ratio))


def _poisson_ratio(value: object) -> float:
    number = finite("poisson_ratio", value)
    if not -1.0 < number <= 0.5:
        raise InputError("must be above -1 and at most 0.5", key="poisson_ratio", value=value)
    return number
