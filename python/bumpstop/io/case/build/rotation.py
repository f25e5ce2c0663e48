"""``[rotation]``: how the shafts turn."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from bumpstop.errors import InputError
from bumpstop.io.case.keys import keyed

if TYPE_CHECKING:
    from bumpstop.io.case.tables.case_file import CaseFile
    from bumpstop.loads import Polynomial, ShaftRotation, TimeTable

__all__ = ["built_rotation", "required_rotation"]

_SPEEDS = ("speed", "polynomial", "table")


def built_rotation(case: CaseFile, folder: Path) -> ShaftRotation | None:
    """Return how the shafts turn; None where nothing is said of it."""
    table = case.rotation
    if table is None:
        return None
    from bumpstop.io.case.build.time import built_table
    from bumpstop.loads import Polynomial, ShaftRotation

    with keyed("rotation"):
        given = [key for key in _SPEEDS if getattr(table, key) is not None]
        if len(given) != 1:
            what, hint = "must have one of speed, polynomial and table", "speed = 300"
            raise InputError(what, value=", ".join(given) or "none", hint=hint)
        speed: float | Polynomial | TimeTable
        if table.polynomial is not None:
            with keyed(renamed={"coefficients": "polynomial"}):
                speed = Polynomial(table.polynomial)
        elif table.table is not None:
            with keyed("table"):
                speed = built_table(table.table, folder)
        else:
            assert table.speed is not None
            speed = table.speed
        with keyed(renamed={"speed": given[0]}):
            return ShaftRotation(
                speed,
                initial_angle=table.initial_angle,
                spin=table.spin,
                acceleration_terms=table.acceleration_terms,
            )


def required_rotation(case: CaseFile, folder: Path) -> ShaftRotation:
    """Return how the shafts turn, for parts that need it.

    Raises
    ------
    InputError
        If the case does not say it.
    """
    rotation = built_rotation(case, folder)
    if rotation is None:
        hint = "a table [rotation] says how the shafts turn, such as speed = 300"
        raise InputError("needs the rotation of the shafts", hint=hint)
    return rotation
