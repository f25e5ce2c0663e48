"""``[sections.NAME]``."""

from typing import Annotated

from pydantic import Field

from bumpstop.io.case.fields.quantities import PositiveLength
from bumpstop.io.case.fields.words import choice
from bumpstop.io.case.tables.table import Table

__all__ = ["SectionTable"]


class SectionTable(Table):
    """A cross section: a solid rectangle."""

    shape: Annotated[str, choice("rectangle")] = Field(description="Shape of the section")
    height: PositiveLength = Field(description="Side along the beam's local y, in m")
    width: PositiveLength = Field(description="Side along the beam's local z, in m")
