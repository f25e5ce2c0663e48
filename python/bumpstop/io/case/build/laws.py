"""Stops and other laws."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from bumpstop.io.case.keys import keyed
from bumpstop.io.case.tables.table import Table
from bumpstop.laws import Stop

if TYPE_CHECKING:
    from bumpstop.io.case.tables.case_file import CaseFile
    from bumpstop.io.case.tables.laws import LawTable
    from bumpstop.io.case.tables.motion import MotionTable
    from bumpstop.io.case.tables.stops import StopTable
    from bumpstop.laws import RigidStop, SpringLaw
    from bumpstop.loads.time import TimeFunction
    from bumpstop.problem import Law

__all__ = ["built_laws"]

ELASTIC = (
    "stiffness",
    "damping",
    "friction",
    "sliding",
    "tangential_stiffness",
    "tangential_damping",
    "motion",
    "frame",
)
"""What a stop that gives way can have."""


def built_laws(case: CaseFile, folder: Path) -> list[Law]:
    """Return the laws that the tables describe; files in them are relative to the folder."""
    laws: list[Law] = []
    for name, table in case.stops.items():
        with keyed(f"stops.{name}"):
            laws.append(_stop(name, table, folder))
    for name, law in case.laws.items():
        with keyed(f"laws.{name}"):
            laws.append(_spring(name, law))
    return laws


def _stop(name: str, table: StopTable, folder: Path) -> Stop | RigidStop:
    from bumpstop.errors import InputError

    given = _given(table)
    if table.motion is not None:
        with keyed("motion"):
            given["motion"] = _motion(table.motion, folder)
    if table.restitution is not None:
        from bumpstop.laws import RigidStop

        for key in ELASTIC:
            if given.pop(key, None):
                hint = "leave it out, or restitution"
                value = getattr(table, key)
                raise InputError("is of no use to a rigid stop", key=key, value=value, hint=hint)
        return RigidStop(name, **given)
    if table.stiffness is None:
        hint = "a rigid stop has a restitution instead"
        raise InputError("is missing", key="stiffness", hint=hint)
    if "resolution" in given:
        what, value = "belongs to rigid stops", given["resolution"]
        raise InputError(what, key="resolution", value=value, hint="leave it out")
    return Stop(name, **given)


def _motion(table: MotionTable, folder: Path) -> list[TimeFunction]:
    from bumpstop.errors import InputError
    from bumpstop.io.case.build.time import built_time
    from bumpstop.loads.time import scaled

    functions = built_time(table, folder)
    if functions is None:
        raise InputError("needs harmonics, a polynomial or a table")
    return [scaled(function, table.travel) for function in functions]


def _spring(name: str, table: LawTable) -> SpringLaw:
    from bumpstop.errors import InputError
    from bumpstop.laws import SpringLaw

    given = _given(table)
    del given["type"]
    curve = given.pop("curve", None)
    if curve is None:
        if "stiffness" not in given:
            raise InputError("must have the slopes of its segments, or a curve", key="stiffness")
        return SpringLaw(name, **given)
    for key in ("stiffness", "breaks", "preload"):
        if key in given:
            raise InputError("is told by the curve already", key=key, value=given[key])
    return SpringLaw.through(curve, name, **given)


def _given(table: Table) -> dict[str, Any]:
    """Return the keys that have a value, the terms as weights by node and dof."""
    given = {key: value for key, value in table if value is not None}
    if "terms" in given:
        given["terms"] = {
            (node, dof): weight
            for node, weights in given["terms"].items()
            for dof, weight in weights.items()
        }
    return given
