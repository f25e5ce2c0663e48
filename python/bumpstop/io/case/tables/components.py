"""``[components.NAME]``."""

from typing import Annotated

from bumpstop.io.case.fields.interface import InnerModes, Interface
from bumpstop.io.case.fields.words import Text, choice
from bumpstop.io.case.tables.matrices import MatricesTable
from bumpstop.io.case.tables.structure import StructureTables
from bumpstop.io.case.tables.table import Field

__all__ = ["ComponentTable"]


class ComponentTable(StructureTables):
    """A structure that is reduced once and placed as [parts] as often as needed.

    It has tables of its own, ``[components.NAME.nodes]``, ``[components.NAME.beams.AB]`` and so
    on, or ``[components.NAME.matrices]``, in its own axes, and may use materials and sections of
    the whole case; or it has the structure of another case file.
    """

    file: Text | None = Field(
        default=None,
        description="Another case file, relative to this one, whose structure it is; tables "
        "written here change or add to that",
    )
    matrices: MatricesTable | None = Field(
        default=None, description="Instead of nodes: matrices from files"
    )
    interface: Interface = Field(
        description='The nodes at which it can be joined or held; `["B", ["dx", "dy"]]` for some '
        "dofs of one"
    )
    reduction: Annotated[str, choice("craig_bampton", "free_interface")] = Field(
        default="craig_bampton",
        description="Modes with the interface held, or with the interface free",
    )
    modes: InnerModes = Field(
        description="Number of modes of the component, 0 or more, beside its rigid motions"
    )
