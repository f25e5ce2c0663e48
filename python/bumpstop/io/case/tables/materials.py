"""``[materials.NAME]``."""

from bumpstop.io.case.fields.quantities import Density, PoissonRatio, Pressure
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["MaterialTable"]


class MaterialTable(Table):
    """A linear elastic, isotropic material."""

    young_modulus: Pressure = Field(description="Young's modulus, in Pa")
    poisson_ratio: PoissonRatio = Field(description="Poisson's ratio, above -1 and at most 0.5")
    density: Density = Field(description="Mass density, in kg/m3")
