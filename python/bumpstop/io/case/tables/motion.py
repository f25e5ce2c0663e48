"""``motion`` of a stop: an obstacle that moves."""

from bumpstop.io.case.fields.quantities import Length
from bumpstop.io.case.tables.table import Field
from bumpstop.io.case.tables.time import TimeKeys

__all__ = ["MotionTable"]


class MotionTable(TimeKeys):
    """How far the obstacle moves along its normal, towards the structure, over time."""

    travel: Length = Field(
        default=1.0, description="How far it has moved where the function of time is one, in m"
    )
