"""Work of sliding by the sector of a round contact in which it is done."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray, count, listed, one_of, pair
from bumpstop.errors import InputError
from bumpstop.post.contacts import integrals_of
from bumpstop.post.spans import spans_within
from bumpstop.post.wear import sliding_spans, sliding_speed, time_window
from bumpstop.projection import TRANSLATIONS

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.response import Response

__all__ = ["work_by_sector"]

SMOOTH = 1e-7
"""Tolerance of the integrals, which begin and end inside contacts, where the sector changes."""


def work_by_sector(
    response: Response,
    stops: str | Sequence[str],
    *,
    sectors: int = 8,
    axes: tuple[str, str] = ("dy", "dz"),
    centre: tuple[float, float] = (0.0, 0.0),
    start: float = 0.0,
    end: float | None = None,
) -> xr.DataArray:
    """Return the work rate of a round contact in each sector of its circle.

    The sector is told by where the node is, seen from the centre of the hole, at each instant:
    for obstacles that are round, and for those made of several planes.

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
    node = _node(response, names)
    first, last = time_window(response, start, end)
    plane = [one_of("axes", axis, TRANSLATIONS) for axis in axes]
    rows = np.array([response.problem.basis.row(node, axis) for axis in plane])
    middle = np.array(pair("centre", centre))
    width = 2.0 * np.pi / count("sectors", sectors)

    def sector(times: FloatArray) -> NDArray[np.intp]:
        y, z = (response.motion(0, times) @ rows.T - middle).T
        turned = np.mod(np.arctan2(z, y), 2.0 * np.pi)
        number: NDArray[np.intp] = (turned / width).astype(np.intp)
        return number.clip(max=sectors - 1)

    total = np.zeros(sectors)
    for stop in names:
        spans = spans_within(sliding_spans(response, stop), first, last)
        powers = _powers(response, response.stop_index(stop), sector, sectors)
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
    response: Response, law: int, sector: Callable[[FloatArray], NDArray[np.intp]], sectors: int
) -> Callable[[FloatArray], FloatArray]:
    speed = sliding_speed(response, law)

    def powers(times: FloatArray) -> FloatArray:
        found = np.zeros((len(times), sectors))
        force = response.history.law_motion(law, times)[2]
        found[np.arange(len(times)), sector(times)] = force * speed(times)
        return found

    return powers


def _node(response: Response, stops: Sequence[str]) -> str:
    laws = [response.problem.laws[response.stop_index(stop)] for stop in stops]
    nodes = list(dict.fromkeys(law.coordinate.node for law in laws))
    if len(nodes) != 1:
        raise InputError("must be one or more stops at one node", key="stops", value=nodes)
    return nodes[0]
