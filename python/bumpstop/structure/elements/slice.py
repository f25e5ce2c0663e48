"""What a slice of a beam resists and weighs."""

from __future__ import annotations

import math
from typing import NamedTuple

from bumpstop.structure.material import Material
from bumpstop.structure.sections.section import Section

__all__ = ["Slice", "slice_of"]


class Slice(NamedTuple):
    """Numbers of a beam's material and section, as its theory sees them.

    The fields are numbers, or arrays of one number an element.
    """

    young: float
    """Young's modulus in Pa."""
    shear: float
    """Shear modulus in Pa."""
    density: float
    """Density in kg/m3."""
    area: float
    """Area in m2."""
    mass_area: float
    """Area in m2 that would weigh as much as the section with what it carries."""
    inertia_y: float
    """Second moment of area about local y, in m4."""
    inertia_z: float
    """Second moment of area about local z, in m4."""
    torsion_constant: float
    """Saint-Venant torsion constant in m4."""
    factor_y: float
    """Share of the area that carries shear along local y; infinite without shear strain."""
    factor_z: float
    """Share of the area that carries shear along local z; infinite without shear strain."""
    rotary_y: float
    """Second moment of area about local y that has rotary inertia, in m4."""
    rotary_z: float
    """Second moment of area about local z that has rotary inertia, in m4."""
    center_y: float
    """Place of the shear centre along local y from the centroid, in m."""
    center_z: float
    """Place of the shear centre along local z from the centroid, in m."""


def slice_of(
    material: Material, section: Section, *, shear: bool, rotary: bool, added_mass: float
) -> Slice:
    """Return the numbers of a material and a section.

    Parameters
    ----------
    material, section
        What the beam is made of.
    shear
        Whether shear strains it.
    rotary
        Whether its sections have rotary inertia in bending.
    added_mass
        Mass a metre that moves with it, in kg/m.
    """
    factor_y, factor_z = section.shear_factors if shear else (math.inf, math.inf)
    inertia_y, inertia_z = section.inertia_y, section.inertia_z
    return Slice(
        young=material.young_modulus,
        shear=material.shear_modulus,
        density=material.density,
        area=section.area,
        mass_area=section.area + added_mass / material.density,
        inertia_y=inertia_y,
        inertia_z=inertia_z,
        torsion_constant=section.torsion_constant,
        factor_y=factor_y,
        factor_z=factor_z,
        rotary_y=inertia_y if rotary else 0.0,
        rotary_z=inertia_z if rotary else 0.0,
        center_y=section.shear_center[0],
        center_z=section.shear_center[1],
    )
