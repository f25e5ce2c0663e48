"""``[sections]``: shapes are loaded when a case has them."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from bumpstop.io.case.fields.factors import COWPER

if TYPE_CHECKING:
    from bumpstop.io.case.tables.sections import SectionTable
    from bumpstop.structure.sections.section import Section

__all__ = ["section_of"]

_SHAPES = {
    "rectangle": "Rectangle",
    "circle": "Circle",
    "tube": "Tube",
    "general": "GeneralSection",
}


def section_of(table: SectionTable, *, poisson_ratio: float) -> Section:
    """Return the section that a table describes.

    Parameters
    ----------
    table
        The table.
    poisson_ratio
        Of the beam's material, for Cowper's shear factors.
    """
    said = {key: value for key, value in dict(table).items() if value is not None}
    shape = said.pop("shape")
    module = import_module(f"bumpstop.structure.sections.{shape}")
    by_formula = said.get("shear_factors") == COWPER
    if by_formula:
        del said["shear_factors"]
    made: Any = getattr(module, _SHAPES[shape])(**said)
    section: Section = made.cowper(poisson_ratio) if by_formula else made
    return section
