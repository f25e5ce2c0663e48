"""``[base_motion]``."""

from bumpstop.io.case.fields.quantities import Acceleration3
from bumpstop.io.case.tables.table import Field
from bumpstop.io.case.tables.time import TimeKeys

__all__ = ["BaseMotionTable"]


class BaseMotionTable(TimeKeys):
    """A translation of all supports, stops with them; motions are told relative to it."""

    acceleration: Acceleration3 = Field(
        description="Components along X, Y, Z of the supports' acceleration where the function "
        "of time is one, in m/s2"
    )
