"""Loads."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop import loads
from bumpstop.io.case.keys import keyed

if TYPE_CHECKING:
    from bumpstop.io.case.tables.case_file import CaseFile
    from bumpstop.io.case.tables.loads import LoadTable
    from bumpstop.problem import Load

__all__ = ["built_loads"]


def built_loads(case: CaseFile) -> list[Load]:
    """Return the loads that the tables describe."""
    return [_load(name, table) for name, table in case.loads.items()]


def _load(name: str, table: LoadTable) -> Load:
    with keyed(f"loads.{name}"):
        if table.type == "gravity":
            return loads.Gravity(name, acceleration=table.acceleration)
        return loads.NodalForce(name, node=table.node, force=table.force, moment=table.moment)
