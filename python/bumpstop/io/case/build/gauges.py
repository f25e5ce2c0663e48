"""Gauges."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.io.case.keys import keyed
from bumpstop.structure import Gauge

if TYPE_CHECKING:
    from bumpstop.io.case.tables.case_file import CaseFile

__all__ = ["built_gauges"]


def built_gauges(case: CaseFile) -> list[Gauge]:
    """Return the gauges that the tables describe."""
    gauges = []
    for name, table in case.gauges.items():
        with keyed(f"gauges.{name}"):
            gauges.append(Gauge(name, beam=table.beam, at=table.at, fibre=table.fibre))
    return gauges
