"""Results about stops: contact statistics and wear."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import count
from bumpstop.post.results.reading import Drawn, Fact, Reading, check_span, check_stop
from bumpstop.quantities import MOST_BLOCKS, MOST_CLASSES, STATISTICS, Quantity

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.post.scars import Scar
    from bumpstop.post.wear import WearLaw
    from bumpstop.problem import Problem
    from bumpstop.response import Response

__all__ = ["Statistics", "Wear"]


@dataclass(frozen=True)
class Statistics:
    """Contact statistics of a stop; see `contact_statistics`."""

    name: str
    _: KW_ONLY
    stop: str
    threshold: float = 0.0
    rest: float = 0.0
    start: float = 0.0
    end: float | None = None
    blocks: int = 10
    classes: int = 10

    def check(self, problem: Problem) -> None:
        """Raise where there is no such stop, or the time is not within the run."""
        check_stop(self.stop, problem)
        check_span(self.start, self.end, problem)
        count("blocks", self.blocks, most=MOST_BLOCKS)
        count("classes", self.classes, most=MOST_CLASSES)

    def read(self, response: Response) -> Reading:
        """Read the statistics, the blocks of the rms force, and histograms."""
        from bumpstop.post.statistics import contact_statistics

        found = contact_statistics(
            response,
            self.stop,
            threshold=self.threshold,
            rest=self.rest,
            start=self.start,
            end=self.end,
            blocks=self.blocks,
            classes=self.classes,
        )
        facts = [
            Fact(what, found.values[name], found.uncertainty[name])
            for name, what in STATISTICS.items()
        ]
        rate = found.by_block["impact_rate"]
        title = f"Impacts a second on {self.stop}, by blocks of time"
        drawn = [Drawn(rate.assign_attrs(drawn="points", title=title))]
        if np.isfinite(found.columns["peak_force"]).any():
            drawn.append(Drawn(found.histogram("peak_force")))
        if found["impact_count"]:
            drawn.append(Drawn(found.histogram("closing_speed")))
        return Reading(facts, drawn)


@dataclass(frozen=True)
class Wear:
    """Wear at a stop; see `wear`."""

    name: str
    _: KW_ONLY
    stop: str
    law: WearLaw
    service: Sequence[float]
    scar: Scar | None = None
    start: float = 0.0
    end: float | None = None

    def check(self, problem: Problem) -> None:
        """Raise where there is no such stop, or the time is not within the run."""
        check_stop(self.stop, problem)
        check_span(self.start, self.end, problem)

    def read(self, response: Response) -> Reading:
        """Read the work rate, and volume and depth over the time of service."""
        from bumpstop.post.wear import wear

        found = wear(
            response,
            self.stop,
            self.law,
            self.service,
            scar=self.scar,
            start=self.start,
            end=self.end,
        )
        rate = Fact(Quantity("W", f"work rate at {self.stop}"), float(found.attrs["work_rate"]))
        last = [
            Fact(
                Quantity(str(array.attrs["units"]), str(array.attrs["long_name"])), float(array[-1])
            )
            for array in found.values()
        ]
        drawn = [Drawn(array) for array in found.values()] if len(self.service) > 1 else []
        return Reading([rate, *last], drawn)


def _quantity(array: xr.DataArray) -> Quantity:
    return Quantity(str(array.attrs["units"]), f"{array.attrs['long_name']} in the end")
