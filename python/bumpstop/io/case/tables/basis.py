"""``[basis]``."""

from typing import Annotated

from bumpstop.io.case.fields.counts import CountFromZero
from bumpstop.io.case.fields.damping import ModalDamping
from bumpstop.io.case.fields.modes import Modes
from bumpstop.io.case.fields.quantities import Ratio
from bumpstop.io.case.fields.shapes import Places, PlacesOrStops
from bumpstop.io.case.fields.words import Dofs, LoadNames, choice
from bumpstop.io.case.tables.table import Field, Table

__all__ = ["BasisTable"]


class BasisTable(Table):
    """The modes and static shapes on which the structure's motion is written."""

    model: Annotated[str, choice("modal", "full")] = Field(
        default="modal",
        description='`"full"` for the structure on its own dofs, not reduced: modes and static '
        "shapes have no part in it then, and the method must be one that takes it",
    )
    mass: Annotated[str, choice("consistent", "lumped")] = Field(
        default="consistent",
        description="Masses of a full model: those of the shape functions, or diagonal ones, "
        "which the explicit method needs",
    )
    modes: Modes | None = Field(
        default=None,
        description='Number of modes, the lowest ones, rigid-body modes included; or `"all"`; '
        "or those of a band or around a frequency, in Hz: `{ band = [0, 500] }`, "
        "`{ around = 120, count = 5 }`",
    )
    damping: ModalDamping = Field(
        default=0.0,
        description="Damping ratio (1 is critical) of every mode; or a list: one a mode; or a "
        "rule: `{ rayleigh = { alpha = 2.0, beta = 1e-5 } }`, "
        "`{ rayleigh = { frequencies = [10, 50], ratios = [0.01, 0.02] } }` or "
        "`{ structural = 0.02 }`, the loss factor. Dampers of the structure add to it",
    )
    damping_coupling: Annotated[str, choice("full", "diagonal")] = Field(
        default="full", description="Whether to keep the damping that couples modes"
    )
    static_shapes: PlacesOrStops = Field(
        default=[],
        description="Displacements under a unit force that join the modes: one for each stop "
        'along its normal, or places such as `["B", "dy"]` or `["B", [0, 0.6, 0.8]]`',
    )
    constraint_shapes: Places = Field(
        default=[],
        description="Displacements that join the modes: each of these places moves by one "
        "while the others are held",
    )
    base_shapes: Dofs = Field(
        default=[],
        description="Displacements that join the modes: those under a steady acceleration of "
        "the supports in these directions",
    )
    load_shapes: LoadNames = Field(
        default=[],
        description="Displacements that join the modes: those under these loads, held still; "
        'by name, or "all"',
    )
    static_damping: Ratio | None = Field(
        default=None,
        description="Damping ratio of these static shapes; as the modes where left out",
    )
    rigid_modes: CountFromZero | None = Field(
        default=None,
        description="How many motions strain nothing; where left out, a structure in one "
        "piece may move as a whole; mechanisms and loose pieces are refused",
    )
