"""Gauges."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop import structure
from bumpstop.io.case.keys import keyed

if TYPE_CHECKING:
    from bumpstop.io.case.tables.case_file import CaseFile
    from bumpstop.structure.gauge import Gauge

__all__ = ["built_gauges"]


def built_gauges(case: CaseFile) -> list[Gauge]:
    """Return the gauges that the tables describe."""
    gauges = []
    for name, table in case.gauges.items():
        with keyed(f"gauges.{name}"):
            gauges.append(structure.Gauge(name, beam=table.beam, at=table.at, fibre=table.fibre))
    return gauges
