"""Forces of laws against the motion that they resist: the loops whose areas are lost work."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.report.curves import MOST_POINTS, contact_spans, instants, thin
from bumpstop.report.plotting import Axis, boundary, layout_of, line_trace
from bumpstop.report.scales import scale_for, with_unit
from bumpstop.sampling import kept_rows

if TYPE_CHECKING:
    from collections.abc import Mapping

    from bumpstop.arguments import FloatArray
    from bumpstop.report.figures import Figure
    from bumpstop.response import Response

__all__ = ["force_loop", "friction_loop"]

MOST_CONTACTS = 200
"""Contacts that are looked at more finely than the samples of the run."""
POINTS_A_CONTACT = 33


def force_loop(response: Response, law: str) -> Figure:
    """Draw the force of a law against what it resists.

    Of a stop that is how far its node has come, as the gap becomes smaller to the right; beyond
    the dashed line it presses. Of any other law it is the deformation. A path that returns where
    it came from loses nothing; the area of a loop is work that is lost.

    Parameters
    ----------
    response
        What to draw.
    law
        Name of the stop or other law.

    Raises
    ------
    InputError
        If there is no such law.
    """
    of = response.problem.laws[response.law_index(law)]
    kind = str(getattr(of, "kind", "stop"))
    times = _instants(response, law)
    gap = response.sample("gap", law, times=times)
    force = response.sample("stop_force", law, times=times)
    if kind != "stop":
        called = " ".join(dict.fromkeys([kind, law]))
        title = f"{called[:1].upper()}{called[1:]}: what it resists", _lost(response, law)
        return _loop(("Deformation", "Resisting force"), title, times, {"Path": gap}, -force)
    title = f"Stop {law}: force against depth", _lost(response, law)
    figure = _loop(("Depth beyond contact", "Force"), title, times, {"Path": -gap}, force)
    figure["layout"]["shapes"] = [boundary(0.0)]
    return figure


def friction_loop(response: Response, stop: str) -> Figure:
    """Draw the friction force of a stop against how far its node has slid along the obstacle.

    A stop whose friction sticks by a spring remembers where the slider at its end stands; the
    force is drawn against that, too. The slider stays while it sticks, and goes with the node,
    behind by what the spring gives, while it slips.

    Raises
    ------
    InputError
        If there is no such stop, or it does not rub along one known direction.
    """
    from bumpstop.errors import InputError

    of: Any = response.problem.laws[response.stop_index(stop)]
    row = of.sliding_row(response.problem.basis) if hasattr(of, "sliding_row") else None
    if row is None:
        hint = "those that rub in two directions have no single loop"
        raise InputError("does not rub in one direction", key="stop", value=stop, hint=hint)
    times = _instants(response, stop)
    ways = {"Node": response.motion(0, times) @ kept_rows(response, row)}
    if "anchor" in getattr(of, "internal_variables", ()):
        ways["Slider"] = response.sample("internal_variable", stop, "anchor", times=times)
    force = response.sample("friction_force", stop, times=times)
    title = f"Stop {stop}: friction against sliding", "What resists the sliding"
    return _loop(("Way along the obstacle", "Friction"), title, times, ways, -force)


def _instants(response: Response, law: str) -> FloatArray:
    """Return instants that show each contact, however short, as a curve."""
    spans = contact_spans(response, law)[:MOST_CONTACTS]
    inside = [np.linspace(start, end, POINTS_A_CONTACT) for start, end in spans if end > start]
    return instants(response, np.concatenate([np.empty(0), *inside]))


def _loop(
    names: tuple[str, str],
    title: tuple[str, str],
    times: FloatArray,
    ways: Mapping[str, FloatArray],
    force: FloatArray,
) -> Figure:
    """Draw a force against one way or several, each with what it is called."""
    every = np.concatenate(list(ways.values()))
    x, y = Axis(names[0], scale_for("m", every)), Axis(names[1], scale_for("N", force))
    clock = scale_for("s", times)
    paths = []
    for (name, way), role in zip(ways.items(), ("computed", "stored"), strict=False):
        # No point where there is no way, as of a slider out of contact: the line has a gap there.
        curves = (np.nan_to_num(way), force)
        kept = np.union1d(*(thin(each, at_most=MOST_POINTS) for each in curves))
        path = line_trace(x.scaled(way[kept]), y.scaled(force[kept]), name, role, y)
        path["line"]["width"] = 1.4
        path["customdata"] = times[kept] * clock.factor
        path["hovertemplate"] = (
            f"%{{y:.5~g}} {y.scale.unit} at %{{x:.5~g}} {x.scale.unit}"
            f"<br>at %{{customdata:.5~g}} {clock.unit}<extra>{name if ways.keys() - {name} else ''}"
            "</extra>"
        )
        paths.append(path)
    layout = layout_of(title[0], x, y, title[1])
    layout["hovermode"] = "closest"
    layout["showlegend"] = len(paths) > 1
    return {"data": paths, "layout": layout}


def _lost(response: Response, law: str) -> str:
    """Return in words what a law has dissipated by the end of the run, from the ledger."""
    end = np.array([response.problem.duration])
    lost = float(response.history.energy(end)["law_dissipated"][response.law_index(law), 0])
    return (
        f"{with_unit(lost, 'J', 4)} lost in it by the end" if lost > 0.0 else "Nothing lost in it"
    )
