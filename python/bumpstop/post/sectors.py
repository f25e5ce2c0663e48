"""Work of sliding by the sector of a round contact in which it is done."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, count, listed, one_of, pair, refuse_twins
from bumpstop.errors import InputError
from bumpstop.post.contacts import integrals_of
from bumpstop.post.of_run import of_run
from bumpstop.post.sliding import motion_at_obstacle, sliding_speed
from bumpstop.post.spans import spans_within
from bumpstop.post.wear import sliding_spans, time_window
from bumpstop.projection import TRANSLATIONS

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.problem import Problem
    from bumpstop.response import Response

__all__ = ["MOST_SECTORS", "check_plane", "check_stops", "work_by_sector"]

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
    import xarray as xr

    names = (stops,) if isinstance(stops, str) else listed("stops", stops)
    check_stops(response.problem, names)
    first, last = time_window(response, start, end)
    plane = check_plane(axes)
    middle = np.array(pair("centre", centre))
    width = 2.0 * np.pi / count("sectors", sectors, most=MOST_SECTORS)
    total = np.zeros(sectors)
    for stop in names:
        spans = spans_within(sliding_spans(response, stop), first, last)
        law = response.stop_index(stop)
        place = motion_at_obstacle(response, law, plane, 0)
        powers = _powers(response, law, place, middle, sectors)
        total += integrals_of(response, spans, powers, SMOOTH).sum(axis=0)
    angles = {"units": "rad", "long_name": f"angle from {axes[0]} towards {axes[1]}"}
    return xr.DataArray(
        total / (last - first),
        dims="angle",
        coords={"angle": ("angle", (np.arange(sectors) + 0.5) * width, angles)},
        name="work rate",
        attrs={"units": "W", "long_name": "work rate by sector", "drawn": "bars"},
    )


def _powers(
    response: Response,
    law: int,
    place: Callable[[FloatArray], FloatArray],
    middle: FloatArray,
    sectors: int,
) -> Callable[[FloatArray], FloatArray]:
    """Return the power of sliding in each sector (time, sectors) as a function of instants."""
    speed = sliding_speed(response, law)

    def powers(times: FloatArray) -> FloatArray:
        y, z = (place(times) - middle).T
        turned = np.mod(np.arctan2(z, y), 2.0 * np.pi) / (2.0 * np.pi)
        sector = (turned * sectors).astype(np.intp).clip(max=sectors - 1)
        found = np.zeros((len(times), sectors))
        force = response.history.law_motion(law, times)[2]
        found[np.arange(len(times)), sector] = force * speed(times)
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
