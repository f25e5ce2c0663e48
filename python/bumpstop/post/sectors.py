"""Work of sliding, and wear, by the sector of a round contact in which it is done."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, count, listed, not_negative, one_of, pair, refuse_twins
from bumpstop.errors import InputError
from bumpstop.post.at_obstacle import motion_at_obstacle
from bumpstop.post.contacts import integrals_of
from bumpstop.post.of_run import of_run
from bumpstop.post.sliding import sliding_speed
from bumpstop.post.spans import spans_within
from bumpstop.post.wear import check_wear, sliding_spans, time_window, wear_work
from bumpstop.projection import TRANSLATIONS

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from bumpstop.post.scars import Scar
    from bumpstop.post.wear import WearLaw
    from bumpstop.problem import Problem
    from bumpstop.response import Response

__all__ = ["MOST_SECTORS", "check_plane", "check_stops", "wear_by_sector", "work_by_sector"]

MOST_SECTORS = 3600
SMOOTH = 1e-7
"""Tolerance of the integrals, which begin and end inside contacts, where the sector changes."""


@of_run
def work_by_sector(
    response: Response,
    stops: str | Sequence[str],
    *,
    sectors: int = 8,
    axes: Sequence[str] = ("dy", "dz"),
    centre: tuple[float, float] = (0.0, 0.0),
    start: float = 0.0,
    end: float | None = None,
) -> xr.DataArray:
    """Return the work rate of a round contact in each sector of its circle.

    The sector is told by where the node is, seen from the centre of the hole, at each instant:
    for obstacles that are round, and for those made of several planes. Where another node carries
    the hole, or supports move past it, that is what the node is seen from.

    Parameters
    ----------
    response
        The run.
    stops
        The stops that make up the obstacle, all at one node.
    sectors
        Number of equal sectors; the first one begins on the first axis and turns to the second.
    axes
        The two dofs that span the plane of the circle.
    centre
        Place of the hole's centre along them, from the node's place at rest, in m.
    start, end
        The time looked at, in s; all of the run where left out.

    Returns
    -------
    xarray.DataArray
        In W over ``angle``, the middle of each sector in rad; they add up to the work rate.

    Raises
    ------
    InputError
        If there is no such stop, they are at several nodes, or a value cannot be used.
    """
    circle = _Circle.of(sectors, axes, centre)
    rates = _sector_rates(response, stops, circle, start, end)
    return circle.labelled(np.sum(list(rates.values()), axis=0), "W", "work rate")


@of_run
def wear_by_sector(
    response: Response,
    stops: str | Sequence[str],
    law: WearLaw,
    service: float,
    *,
    sectors: int = 8,
    axes: Sequence[str] = ("dy", "dz"),
    centre: tuple[float, float] = (0.0, 0.0),
    scar: Scar | None = None,
    start: float = 0.0,
    end: float | None = None,
) -> xr.Dataset:
    """Return the wear in each sector of a round contact after a time of service.

    Each stop wears as its law says, see `wear`, and each sector has its share of that by its share
    of the stop's work.

    Parameters
    ----------
    response, stops, sectors, axes, centre, start, end
        As `work_by_sector` takes them.
    law
        ``ArchardWear``, ``EdfWear`` or ``KwuEpriWear``.
    service
        The time of service in s that the run stands for.
    scar
        Shape of the scar in one sector, for its depth; evenly worn it is a `PadScar` of the area
        ``2 pi r l / sectors``.

    Returns
    -------
    xarray.Dataset
        ``work_rate`` in W, ``volume`` in m3 and, with a scar, ``depth`` in m over ``angle``, the
        middle of each sector in rad.

    Raises
    ------
    InputError
        As `work_by_sector` and `wear` do.
    """
    import xarray as xr

    check_wear(law, scar)
    circle = _Circle.of(sectors, axes, centre)
    times = np.array([not_negative("service", service)])
    rates = _sector_rates(response, stops, circle, start, end)
    volumes = np.zeros(circle.count)
    for stop, rate in rates.items():
        if rate.any():
            work = wear_work(response, stop, start=start, end=end)
            volumes += float(law.volume(work, times)[0]) * rate / rate.sum()
    found = {
        "work_rate": circle.labelled(np.sum(list(rates.values()), axis=0), "W", "work rate"),
        "volume": circle.labelled(volumes, "m^3", "worn volume"),
    }
    if scar is not None:
        depths = np.array([scar.depth(volume) for volume in volumes.tolist()])
        found["depth"] = circle.labelled(depths, "m", "depth of the scar")
    return xr.Dataset(found, attrs={"service": float(times[0])})


@dataclass(frozen=True)
class _Circle:
    """Equal sectors of a circle."""

    count: int
    axes: tuple[str, ...]
    centre: FloatArray

    @classmethod
    def of(cls, sectors: int, axes: Sequence[str], centre: tuple[float, float]) -> _Circle:
        number = count("sectors", sectors, most=MOST_SECTORS)
        return cls(number, tuple(check_plane(axes)), np.array(pair("centre", centre)))

    def sector(self, places: FloatArray) -> NDArray[np.intp]:
        """Return the numbers of the sectors that some places (time, 2) are in."""
        y, z = (places - self.centre).T
        turned = np.mod(np.arctan2(z, y), 2.0 * np.pi) / (2.0 * np.pi)
        numbers: NDArray[np.intp] = (turned * self.count).astype(np.intp)
        return np.minimum(numbers, self.count - 1)

    def labelled(self, values: FloatArray, units: str, words: str) -> xr.DataArray:
        """Return a number a sector as an array over ``angle``."""
        import xarray as xr

        middles = (np.arange(self.count) + 0.5) * (2.0 * np.pi / self.count)
        told = {"units": "rad", "long_name": f"angle from {self.axes[0]} towards {self.axes[1]}"}
        return xr.DataArray(
            values,
            dims="angle",
            coords={"angle": ("angle", middles, told)},
            name=words,
            attrs={"units": units, "long_name": f"{words} by sector", "drawn": "bars"},
        )


def _sector_rates(
    response: Response,
    stops: str | Sequence[str],
    circle: _Circle,
    start: float,
    end: float | None,
) -> dict[str, FloatArray]:
    """Return the work rate in W of each stop in each sector."""
    names = (stops,) if isinstance(stops, str) else listed("stops", stops)
    check_stops(response.problem, names)
    first, last = time_window(response, start, end)
    rates = {}
    for stop in names:
        law = response.stop_index(stop)
        spans = spans_within(sliding_spans(response, stop), first, last)
        powers = _powers(response, law, circle)
        rates[stop] = integrals_of(response, spans, powers, SMOOTH).sum(axis=0) / (last - first)
    return rates


def _powers(response: Response, law: int, circle: _Circle) -> Callable[[FloatArray], FloatArray]:
    """Return the power of sliding in each sector (time, sectors) as a function of instants."""
    speed = sliding_speed(response, law)
    place = motion_at_obstacle(response, law, circle.axes, 0)

    def powers(times: FloatArray) -> FloatArray:
        found = np.zeros((len(times), circle.count))
        force = response.history.law_motion(law, times)[2]
        found[np.arange(len(times)), circle.sector(place(times))] = force * speed(times)
        return found

    return powers


def check_stops(problem: Problem, stops: Sequence[str]) -> None:
    """Raise where a problem has not these stops, or they are not at one node."""
    for stop in stops:
        one_of("stops", stop, problem.stop_names)
    refuse_twins("stops", stops)
    laws = [law for law in problem.laws if law.name in stops]
    nodes = list(dict.fromkeys(law.coordinate.node for law in laws))
    if len(nodes) != 1:
        raise InputError("must be one or more stops at one node", key="stops", value=nodes)


def check_plane(axes: Sequence[str]) -> list[str]:
    """Return the two dofs that span a plane, or raise where they do not."""
    plane = [one_of("axes", axis, TRANSLATIONS) for axis in listed("axes", axes)]
    if len(set(plane)) != 2 or len(plane) != 2:
        raise InputError("must be two different dofs", key="axes", value=axes)
    return plane
