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
    from bumpstop.post.scars import Scar
    from bumpstop.post.wear import WearLaw
    from bumpstop.problem import Problem
    from bumpstop.response import Response

__all__ = ["SectorWork", "Statistics", "Wear"]


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


@dataclass(frozen=True)
class SectorWork:
    """Work rate of a round contact by sectors of its circle; see `work_by_sector`."""

    name: str
    _: KW_ONLY
    stops: Sequence[str]
    sectors: int = 8
    axes: Sequence[str] = ("dy", "dz")
    centre: tuple[float, float] = (0.0, 0.0)
    start: float = 0.0
    end: float | None = None

    def check(self, problem: Problem) -> None:
        """Raise where the stops are none of one node, or the time is not within the run."""
        from bumpstop.post.sectors import MOST_SECTORS, check_plane, check_stops

        check_stops(problem, self.stops)
        check_plane(self.axes)
        count("sectors", self.sectors, most=MOST_SECTORS)
        check_span(self.start, self.end, problem)

    def read(self, response: Response) -> Reading:
        """Read the work rate of each sector, and which takes most."""
        from bumpstop.post.sectors import work_by_sector

        found = work_by_sector(
            response,
            self.stops,
            sectors=self.sectors,
            axes=self.axes,
            centre=self.centre,
            start=self.start,
            end=self.end,
        )
        where = ", ".join(self.stops)
        most = int(np.argmax(found.values))
        total = Fact(Quantity("W", f"work rate at {where}"), float(found.sum()))
        largest = Fact(Quantity("W", "largest work rate of a sector"), float(found[most]))
        angle = Quantity("rad", f"middle of that sector, {found['angle'].attrs['long_name']}")
        titled = found.assign_attrs(title=f"Work rate by sector at {where}")
        facts = [total, largest, Fact(angle, float(found["angle"][most]))]
        return Reading(facts if total.value > 0.0 else [total], [Drawn(titled)])
