"""``[gauges.NAME]``."""

from bumpstop.io.case.fields.quantities import Length, Length2
from bumpstop.io.case.fields.words import BeamName
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["GaugeTable"]


class GaugeTable(Table):
    """A strain gauge: it reads the strain along the beam's axis."""

    beam: BeamName = Field(description="Name of one of the [beams], or of a part's")
    at: Length = Field(description="Distance from the beam's first node, in m")
    fibre: Length2 = Field(description="Place in the section: local y and z from its centre, in m")
