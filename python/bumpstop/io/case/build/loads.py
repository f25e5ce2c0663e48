"""Loads."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from bumpstop import loads
from bumpstop.io.case.keys import keyed
from bumpstop.io.case.tables.table import keys_of, written_keys

if TYPE_CHECKING:
    from bumpstop.io.case.tables.base_motion import BaseMotionTable
    from bumpstop.io.case.tables.case_file import CaseFile
    from bumpstop.io.case.tables.loads import LoadTable
    from bumpstop.io.case.tables.time import TimeKeys
    from bumpstop.loads.time import TimeFunction
    from bumpstop.problem import Load

__all__ = ["BASE_MOTION", "built_loads"]

_CLASSES = {
    "force": "NodalForce",
    "line_force": "LineForce",
    "moving_force": "MovingForce",
    "support_motion": "SupportMotion",
}
BASE_MOTION = "base_motion"
"""Table of the motion of the supports, and the name of the load that it makes."""


def built_loads(case: CaseFile, folder: Path) -> list[Load]:
    """Return the loads that the tables describe; files in them are relative to the folder."""
    built = [_load(case, name, folder) for name in case.loads]
    return built if case.base_motion is None else [*built, _base_motion(case.base_motion, folder)]


def _load(case: CaseFile, name: str, folder: Path) -> Load:
    table: LoadTable = case.loads[name]
    with keyed(f"loads.{name}"):
        if table.type == "gravity":
            return loads.Gravity(name, acceleration=table.acceleration)
        if table.type == "turbulence":
            from bumpstop.io.case.build.random import built_turbulence

            return built_turbulence(name, table, folder)
        if table.type == "unbalance":
            from bumpstop.io.case.build.rotation import required_rotation

            own = {key: value for key, value in table if key != "type"}
            return loads.Unbalance(name, rotation=required_rotation(case, folder), **own)
        made: Load = getattr(loads, _CLASSES[table.type])(name, **_said(table, folder))
        return made


def _base_motion(table: BaseMotionTable, folder: Path) -> Load:
    with keyed(BASE_MOTION):
        return loads.BaseMotion(name=BASE_MOTION, **_said(table, folder))


def _said(table: TimeKeys, folder: Path) -> dict[str, Any]:
    """Return the arguments that the keys of a table mean."""
    own = {key: value for key, value in table if key not in {"type", *_time_keys()}}
    return own | {"time": _time(table, folder)}


def _time(table: TimeKeys, folder: Path) -> list[TimeFunction] | None:
    if written_keys(table).isdisjoint(_time_keys()):
        return None
    from bumpstop.io.case.build.time import built_time

    return built_time(table, folder)


def _time_keys() -> tuple[str, ...]:
    """Return the keys of a load that say how it changes."""
    from bumpstop.io.case.tables.time import TimeKeys

    return tuple(keys_of(TimeKeys))
