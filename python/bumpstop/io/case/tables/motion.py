"""``motion`` of a stop: an obstacle that moves."""

from bumpstop.io.case.fields.quantities import Length
from bumpstop.io.case.tables.table import Field
from bumpstop.io.case.tables.time import TimeKeys

__all__ = ["MotionTable", "TravelTable"]

_ALONG = 'How an obstacle about an axis, or one with sliding = "plane", moves along the global '


class TravelTable(TimeKeys):
    """How far an obstacle moves along one direction over time."""

    travel: Length = Field(
        default=1.0, description="How far it has moved where the function of time is one, in m"
    )


class MotionTable(TravelTable):
    """How far the obstacle moves: along its normal, towards the structure, or along axes."""

    dx: TravelTable | None = Field(default=None, description=_ALONG + "x axis")
    dy: TravelTable | None = Field(default=None, description=_ALONG + "y axis")
    dz: TravelTable | None = Field(default=None, description=_ALONG + "z axis")
