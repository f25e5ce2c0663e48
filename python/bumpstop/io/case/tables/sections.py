"""``[sections.NAME]``: one table a shape."""

from typing import Annotated, Literal

from bumpstop.io.case.fields.factors import PlainShearFactors, ShearFactors
from bumpstop.io.case.fields.quantities import (
    Area,
    AreaMoment,
    Length2,
    PositiveLength,
)
from bumpstop.io.case.tables.table import Field, Kinds, Table

__all__ = ["CircleTable", "GeneralSectionTable", "RectangleTable", "SectionTable", "TubeTable"]

_FACTORS = 'Shares of the area that carry shear along local y and z, or "cowper"'


class RectangleTable(Table):
    """A rectangle, solid or hollow."""

    shape: Literal["rectangle"] = Field(description="Shape of the section")
    height: PositiveLength = Field(description="Side along the beam's local y, in m")
    width: PositiveLength = Field(description="Side along the beam's local z, in m")
    thickness: PositiveLength | None = Field(
        default=None, description="Thickness of the wall, in m; solid where left out"
    )
    shear_factors: ShearFactors | None = Field(default=None, description=_FACTORS)


class CircleTable(Table):
    """A solid circle."""

    shape: Literal["circle"] = Field(description="Shape of the section")
    radius: PositiveLength = Field(description="Radius, in m")
    shear_factors: ShearFactors | None = Field(default=None, description=_FACTORS)


class TubeTable(Table):
    """A circular tube."""

    shape: Literal["tube"] = Field(description="Shape of the section")
    outer_radius: PositiveLength = Field(description="Outer radius, in m")
    thickness: PositiveLength = Field(description="Thickness of the wall, in m")
    shear_factors: ShearFactors | None = Field(default=None, description=_FACTORS)


class GeneralSectionTable(Table):
    """A section of any shape, by its numbers; local y and z are its principal axes."""

    shape: Literal["general"] = Field(description="Shape of the section")
    area: Area = Field(description="Area, in m2")
    inertia_y: AreaMoment = Field(description="Integral of z2 over the area, in m4")
    inertia_z: AreaMoment = Field(description="Integral of y2 over the area, in m4")
    torsion_constant: AreaMoment = Field(description="Saint-Venant torsion constant, in m4")
    shear_factors: PlainShearFactors = Field(
        default=(1.0, 1.0), description="Shares of the area that carry shear along local y and z"
    )
    shear_center: Length2 = Field(
        default=(0.0, 0.0), description="Its y and z from the centroid, in m"
    )
    extent_y: Length2 | None = Field(
        default=None, description="Least and greatest y of the section, in m, to check gauges by"
    )
    extent_z: Length2 | None = Field(
        default=None, description="Least and greatest z of the section, in m, to check gauges by"
    )


SectionTable = Annotated[
    RectangleTable | CircleTable | TubeTable | GeneralSectionTable, Kinds("shape")
]
