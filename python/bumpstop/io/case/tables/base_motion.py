"""``[base_motion]``, and motions of some supports."""

from typing import Annotated, Literal

from bumpstop.io.case.fields.quantities import Acceleration3, Length3
from bumpstop.io.case.fields.words import Nodes, choice
from bumpstop.io.case.tables.table import Field
from bumpstop.io.case.tables.time import TimeKeys

__all__ = ["BaseMotionTable", "SupportMotionTable"]


class _MotionTable(TimeKeys):
    """How supports move."""

    acceleration: Acceleration3 | None = Field(
        default=None,
        description="Components along X, Y, Z of the supports' acceleration where the function "
        "of time is one, in m/s2; they start at rest",
    )
    displacement: Length3 | None = Field(
        default=None,
        description="Instead: components of their displacement, in m, with harmonics or a "
        "polynomial",
    )


class BaseMotionTable(_MotionTable):
    """A translation of all supports, stops with them."""

    frame: Annotated[str, choice("relative", "absolute")] = Field(
        default="relative",
        description="Whether results tell motions relative to the supports, or absolute ones",
    )


class SupportMotionTable(_MotionTable):
    """A translation of some supports; results tell absolute motions."""

    type: Literal["support_motion"] = Field(description="Kind of load")
    nodes: Nodes = Field(description="The nodes that move, which supports hold")
