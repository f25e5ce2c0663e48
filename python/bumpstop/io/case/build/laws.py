"""Stops and other laws."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.io.case.keys import keyed
from bumpstop.laws import Stop

if TYPE_CHECKING:
    from bumpstop.io.case.tables.case_file import CaseFile

__all__ = ["built_laws"]


def built_laws(case: CaseFile) -> list[Stop]:
    """Return the laws that the tables describe."""
    laws = []
    for name, table in case.stops.items():
        with keyed(f"stops.{name}"):
            laws.append(Stop(name, **dict(table)))
    return laws
