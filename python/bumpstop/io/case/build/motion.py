"""How the obstacles of stops move."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from bumpstop.errors import InputError
from bumpstop.io.case.keys import keyed
from bumpstop.io.case.tables.table import written_keys
from bumpstop.projection import TRANSLATIONS

if TYPE_CHECKING:
    from bumpstop.io.case.tables.motion import MotionTable, TravelTable
    from bumpstop.loads.time import TimeFunction

__all__ = ["along_axes", "along_normal"]


def along_normal(table: MotionTable, folder: Path) -> list[TimeFunction]:
    """Return the functions whose sum moves a plane along its normal.

    Raises
    ------
    InputError
        If there are none, or some along axes.
    """
    for dof in TRANSLATIONS:
        if getattr(table, dof) is not None:
            hint = 'leave it out, or take a circle, a polar profile or sliding = "plane"'
            raise InputError("a plane moves along its normal", key=dof, hint=hint)
    return _functions(table, folder)


def along_axes(table: MotionTable, folder: Path) -> dict[str, list[TimeFunction]]:
    """Return the functions whose sums move an obstacle of a shape along the global axes.

    Raises
    ------
    InputError
        If there are none, or some that say along which.
    """
    axes = {dof: getattr(table, dof) for dof in TRANSLATIONS}
    along = {dof: own for dof, own in axes.items() if own is not None}
    rest = sorted(written_keys(table) - set(TRANSLATIONS))
    if rest or not along:
        what = "must say along which axes the obstacle moves"
        hint = 'such as motion.dy = { travel = "1 mm", harmonics = [...] }'
        raise InputError(what, key=rest[0] if rest else None, hint=hint)
    moved = {}
    for dof, own in along.items():
        with keyed(dof):
            moved[dof] = _functions(own, folder)
    return moved


def _functions(table: TravelTable, folder: Path) -> list[TimeFunction]:
    from bumpstop.io.case.build.time import built_time
    from bumpstop.loads.time import scaled

    functions = built_time(table, folder)
    if functions is None:
        raise InputError("needs harmonics, a polynomial or a table")
    return [scaled(function, table.travel) for function in functions]
