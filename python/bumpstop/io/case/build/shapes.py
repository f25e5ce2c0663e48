"""Stops about an axis, on two planes, and at several nodes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from bumpstop.errors import InputError

if TYPE_CHECKING:
    from bumpstop.io.case.tables.stops import StopTable
    from bumpstop.laws import CircleStop, PlaneStop, PolarStop

__all__ = ["AROUND", "faces", "plane_stop", "shaped_stop"]

AROUND = ("circle", "polar")
"""Obstacles about an axis."""
_OF_PLANES = (
    "normal",
    "terms",
    "half_thickness",
    "other_half_thickness",
    "exponent",
    "hunt_crossley",
    "restitution",
    "resolution",
    "sliding",
)
"""What planes alone have."""
_OF_SIMPLE_PLANES = ("terms", "exponent", "hunt_crossley")
"""What planes that rub in two directions do not have."""
_OF_CIRCLES = ("radius", "body_radius", "side")


def faces(name: str, table: StopTable) -> Iterator[tuple[str, StopTable]]:
    """Yield name and table of each stop that a table stands for.

    Raises
    ------
    InputError
        If it has both a node and nodes, or two planes and no normal.
    """
    if table.nodes is None:
        yield from _of_planes(name, table)
        return
    for key, value in (("node", table.node), ("terms", table.terms)):
        if value is not None:
            raise InputError("is told by the nodes already", key=key, value=value)
    if isinstance(table.nodes, str):
        what = "must be a list of nodes: not everything is stopped"
        raise InputError(what, key="nodes", value=table.nodes)
    for node in table.nodes:
        single = table.replaced(node=node, nodes=None)
        yield from _of_planes(f"{name}.{node}", single)


def _of_planes(name: str, table: StopTable) -> Iterator[tuple[str, StopTable]]:
    """Yield both planes of two, or what is no two planes as it is."""
    if table.obstacle != "two_planes":
        yield name, table
        return
    if table.normal is None:
        what = "is missing: two planes stand across it"
        raise InputError(what, key="normal")
    for sign in (1.0, -1.0):
        x, y, z = (sign * part for part in table.normal)
        yield (
            name + ("+" if sign > 0.0 else "-"),
            table.replaced(normal=(x, y, z), obstacle="plane"),
        )


def shaped_stop(name: str, given: dict[str, Any]) -> CircleStop | PolarStop:
    """Return the stop about an axis that a table's keys describe.

    Raises
    ------
    InputError
        If one of them is missing, or of no use to it.
    """
    obstacle = given.pop("obstacle")
    gap = given.pop("gap")
    for key in _OF_PLANES:
        if key in given:
            raise InputError(f"is of no use to a {obstacle}", key=key, value=given[key])
    for key in ("axis", "stiffness", "node"):
        if key not in given:
            raise InputError("is missing", key=key, hint=f"a {obstacle} needs it")
    given["stiffness"] = float(given["stiffness"])
    if obstacle == "polar":
        return _polar(name, gap, given)
    if gap:
        if "radius" in given or given.get("side") == "outside":
            what = "is told by the radii already"
            raise InputError(what, key="gap", value=gap)
        given["radius"] = gap
    elif "radius" not in given:
        raise InputError("is missing", key="radius", hint="or give the gap all around")
    if "profile" in given:
        raise InputError("belongs to polar obstacles", key="profile")
    from bumpstop.laws import CircleStop

    return CircleStop(name, **given)


def plane_stop(name: str, given: dict[str, Any]) -> PlaneStop:
    """Return the stop on a plane, rubbing in two directions, that a table's keys describe.

    Raises
    ------
    InputError
        If one of them is of no use to it.
    """
    from bumpstop.laws import PlaneStop

    del given["sliding"], given["obstacle"]
    for key in _OF_SIMPLE_PLANES:
        if key in given:
            what = "is of no use to a stop that rubs in two directions"
            raise InputError(what, key=key, value=given[key])
    given["stiffness"] = float(given["stiffness"])
    return PlaneStop(name, **given)


def _polar(name: str, gap: float, given: dict[str, Any]) -> PolarStop:
    from bumpstop.laws import PolarStop

    if gap:
        raise InputError("is told by the profile already", key="gap", value=gap)
    for key in _OF_CIRCLES:
        if key in given:
            raise InputError("belongs to circles", key=key, value=given[key])
    if "profile" not in given:
        raise InputError("is missing", key="profile", hint="give [angle, radius] of each corner")
    return PolarStop(name, **given)
