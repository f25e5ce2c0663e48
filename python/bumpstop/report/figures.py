"""Figures of a response, as plain dicts in plotly's JSON form.

Each function is pure: a response goes in, ``{"data": [...], "layout": {...}}`` comes out,
with NumPy arrays as coordinates. Nothing here imports plotly; `as_plotly` turns such a dict
into a figure for a notebook. Colours are those of light paper (see `palette`).
"""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from bumpstop.laws.shaped_stop import ShapedStop
from bumpstop.report.balance import ledger_instants, residual_told
from bumpstop.report.curves import MOST_POINTS, contact_spans, instants, state_spans, thin
from bumpstop.report.palette import LIGHT
from bumpstop.report.plotting import (
    MOST_BANDS,
    Axis,
    bands,
    boundary,
    contact_bands,
    layout_of,
    line_trace,
    whole_run,
)
from bumpstop.report.scales import percent, scale_for
from bumpstop.report.stops import fixed_stops
from bumpstop.report.words import title_of, unit_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import plotly.graph_objects as go

    from bumpstop.arguments import FloatArray
    from bumpstop.post.references import Reference
    from bumpstop.response import Response

__all__ = [
    "Figure",
    "as_plotly",
    "energy_ledger",
    "friction_force",
    "gap",
    "gauge_strain",
    "node_motion",
    "phase_portrait",
    "stop_force",
]

Figure: TypeAlias = dict[str, Any]

HEADED = 104
"""Margin in pixels above a figure that has a heading, a line below it, and a legend."""

LARGEST_RING = 6
"""Size of a ring in pixels: plotly would tell of the curve through the middle of a larger one."""

LEDGER = {
    "kinetic": ("Kinetic", "kinetic"),
    "elastic": ("Elastic", "elastic"),
    "stored": ("In stops", "stored"),
    "dissipated_damping": ("Lost to damping", "damping"),
    "dissipated_stops": ("Lost in stops", "stops"),
}
"""Terms of the ledger in the order of their stack: name and colour role."""


def as_plotly(figure: Figure) -> go.Figure:
    """Return a figure of this module as a plotly figure, to show or change.

    Examples
    --------
    >>> as_plotly({"data": [{"type": "scatter", "y": [1, 2]}], "layout": {}}).data[0].y
    (1, 2)
    """
    import plotly.graph_objects as go

    drawn = go.Figure(figure)
    if "subtitle" in figure["layout"].get("title", {}) and drawn.layout.showlegend is not False:
        # Heading and legend stand one above the other.
        drawn.update_layout(margin_t=HEADED, title={"y": 0.97, "yanchor": "top"})
    return drawn


def node_motion(
    response: Response,
    quantity: str,
    node: str,
    dof: str,
    references: Sequence[Reference] = (),
) -> Figure:
    """Draw the displacement, velocity or acceleration of a node over time.

    Parameters
    ----------
    response
        What to draw.
    quantity
        ``"displacement"``, ``"velocity"`` or ``"acceleration"``.
    node, dof
        Where: a node's name or a point along a beam, and one of its dofs.
    references
        Published values; those of this quantity at this place are drawn on the curve.
    """
    axis = f"{quantity.capitalize()} {dof}"
    return _over_time(response, (quantity, node, dof), axis, references)


def stop_force(response: Response, stop: str, references: Sequence[Reference] = ()) -> Figure:
    """Draw the force of a stop, or of another law, on the structure over time."""
    figure = _over_time(response, ("stop_force", stop), "Force", references)
    kind = _kind(response, stop)
    figure["data"][0]["line"]["color"] = LIGHT["contact"]
    if kind != "stop":
        return _entitled(figure, f"Force of {kind} {stop}")
    # A stop pushes and never pulls.
    figure["data"][0] |= {"fill": "tozeroy", "fillcolor": "rgba(213, 94, 0, 0.12)"}
    figure["layout"]["yaxis"]["rangemode"] = "nonnegative"
    return figure


def friction_force(response: Response, stop: str, references: Sequence[Reference] = ()) -> Figure:
    """Draw the force of a stop along its obstacle over time, shaded while it sticks.

    Where it rubs in two directions both are drawn: around an axis, and along it.
    """
    figure = _over_time(response, ("friction_force", stop), "Force", references)
    law = response.problem.laws[response.law_index(stop)]
    if isinstance(law, ShapedStop):
        return _in_two_directions(figure, response, law)
    clock = scale_for("s", response.problem.duration)
    figure["layout"]["shapes"] = bands(state_spans(response, stop, "stick"), clock)
    return figure


def gap(response: Response, stop: str, references: Sequence[Reference] = ()) -> Figure:
    """Draw the distance between the structure and a stop over time, negative while pressed.

    Of another law it is the deformation.
    """
    kind = _kind(response, stop)
    name = "Gap" if kind == "stop" else "Deformation"
    figure = _over_time(response, ("gap", stop), name, references)
    return figure if kind == "stop" else _entitled(figure, f"Deformation of {kind} {stop}")


def _kind(response: Response, name: str) -> str:
    """Return what a law is called in words."""
    law = response.problem.laws[response.law_index(name)]
    return str(getattr(law, "kind", "stop"))


def _entitled(figure: Figure, title: str) -> Figure:
    figure["layout"]["title"]["text"] = escape(title, quote=False)
    return figure


def _in_two_directions(figure: Figure, response: Response, law: ShapedStop) -> Figure:
    """Return the same with the forces in both directions in which a stop rubs."""
    times = instants(response)
    forces = response.history.contact_forces(response.law_index(law.name), times)[:, 1:]
    clock, force = scale_for("s", response.problem.duration), scale_for("N", forces)
    figure["layout"]["yaxis"] = Axis("Force", force).layout()
    known = ("around the axis", "along the axis")
    if law.obstacle == "plane":
        known = ("first direction", "second direction")
    computed, *published = figure["data"]
    drawn = []
    for name, role, values in zip(known, ("computed", "damping"), forces.T, strict=True):
        kept = thin(values)
        points = {"x": times[kept] * clock.factor, "y": values[kept] * force.factor}
        told = f"{name}: %{{y:.5~g}} {force.unit}<br>at %{{x:.5~g}} {clock.unit}<extra></extra>"
        line = computed["line"] | {"color": LIGHT[role]}
        drawn.append(computed | points | {"name": name, "line": line, "hovertemplate": told})
    layout = figure["layout"] | {"showlegend": True}
    largest = force.show(float(np.hypot(*forces.T).max()))
    layout["title"]["subtitle"]["text"] = f"At most {largest} {force.unit}"
    return {"data": [*drawn, *published], "layout": layout}


def gauge_strain(response: Response, gauge: str, references: Sequence[Reference] = ()) -> Figure:
    """Draw the axial strain that a gauge reads over time, in microstrain."""
    return _over_time(response, ("gauge", gauge), "Strain", references)


def energy_ledger(response: Response) -> Figure:
    """Stack where the energy is over time, against what was put in.

    The top of the stack is kinetic + elastic + stored + dissipated; the dashed line is the
    initial energy plus the work of loads, circulatory forces and obstacles. They coincide where
    the ledger closes.
    """
    times = instants(response)
    terms = response.energy_terms(times)
    present = [key for key in LEDGER if np.any(terms[key])]
    share = MOST_POINTS // max(len(present), 1)
    kept = np.unique([0, *(i for key in present for i in thin(terms[key], at_most=share))])
    works = [
        name for name in ("load_work", "circulatory_work", "obstacle_work") if np.any(terms[name])
    ]
    given = sum((terms[name] for name in works), start=terms["total_initial"])[kept]
    time = Axis("Time", scale_for("s", times))
    energy = Axis("Energy", scale_for("J", given))
    x = time.scaled(times[kept])
    stack = []
    for key in present:
        name, role = LEDGER[key]
        term = line_trace(x, energy.scaled(terms[key][kept]), name, role, energy)
        term |= {"stackgroup": "energy", "fillcolor": LIGHT[role], "opacity": 0.9}
        term["line"]["width"] = 0
        stack.append(term)
    name = "Initial + work put in" if works else "Initial energy"
    total = line_trace(x, energy.scaled(given), name, "total", energy)
    total["line"] |= {"dash": "dash", "width": 1.5}
    residual = residual_told(response.energy_residual, "less than")
    subtitle = f"Closes to {residual} of the largest energy, {ledger_instants(response)}"
    layout = layout_of("Energy", time, energy, subtitle)
    layout["xaxis"] |= whole_run(response, time)
    layout["legend"]["traceorder"] = "normal"
    return {"data": [*stack, total], "layout": layout}


def phase_portrait(response: Response, node: str, dof: str) -> Figure:
    """Draw velocity against displacement of a node, with its impacts marked.

    A dashed line shows where a stop at that node, facing along that dof, begins to push.
    """
    times = instants(response)
    displacement = response.sample("displacement", node, dof, times=times)
    velocity = response.sample("velocity", node, dof, times=times)
    kept = np.union1d(
        thin(displacement, at_most=MOST_POINTS // 2), thin(velocity, at_most=MOST_POINTS // 2)
    )
    x = Axis(f"Displacement {dof}", scale_for(unit_of("displacement", dof), displacement))
    y = Axis(f"Velocity {dof}", scale_for(unit_of("velocity", dof), velocity))
    clock = scale_for("s", times)
    path = line_trace(x.scaled(displacement[kept]), y.scaled(velocity[kept]), "Path", "computed", y)
    path["customdata"] = times[kept] * clock.factor
    path["hovertemplate"] = (
        f"%{{x:.5~g}} {x.scale.unit}, %{{y:.5~g}} {y.scale.unit}"
        f"<br>at %{{customdata:.5~g}} {clock.unit}"
    )
    marks = []
    for name, moments, marker in _portrait_marks(response, node):
        at = np.searchsorted(times, moments)
        points = {"x": x.scaled(displacement[at]), "y": y.scaled(velocity[at])}
        told = {"name": name, "mode": "markers", "marker": marker}
        marks.append(path | points | told | {"customdata": times[at] * clock.factor})
    places = _contact_places(response, node, dof)
    subtitle = "Dashed: where the stop is touched" if places else "Velocity against displacement"
    layout = layout_of(f"Phase portrait of {node}, {dof}", x, y, subtitle)
    layout["hovermode"] = "closest"
    layout["shapes"] = [boundary(x.scale.factor * place) for place in places]
    return {"data": [path, *marks], "layout": layout}


def _portrait_marks(
    response: Response, node: str
) -> Iterator[tuple[str, list[float], dict[str, Any]]]:
    """Yield name, instants and marker of what is worth a mark on a node's path."""
    ring = {"symbol": "circle-open", "size": 13, "color": LIGHT["ink"], "line": {"width": 1.8}}
    yield "Start", [0.0], ring
    stops = [law.name for law in response.problem.laws if law.coordinate.node == node]
    spans = [span for stop in stops for span in contact_spans(response, stop)]
    if not 0 < len(spans) <= MOST_BANDS:
        return
    starts = [start for start, _ in spans]
    yield "Contact begins", starts, _triangle("triangle-down", "contact")
    ends = [end for _, end in spans if end < response.problem.duration]
    if ends:
        yield "Contact ends", ends, _triangle("triangle-up", "stops")


def _triangle(symbol: str, role: str) -> dict[str, Any]:
    return {"symbol": symbol, "size": 9, "color": LIGHT[role]}


def _over_time(
    response: Response,
    target: tuple[str, ...],
    axis: str,
    references: Sequence[Reference],
) -> Figure:
    published = [reference for reference in references if reference.target == target]
    moments = np.array([time for reference in published for time in reference.times])
    wanted = np.array([value for reference in published for value in reference.values])
    times = instants(response, moments)
    values = response.sample(*target, times=times)
    kept = thin(values, keep=np.isin(times, moments))
    time = Axis("Time", scale_for("s", times))
    unit = unit_of(target[0], target[2] if len(target) > 2 else None)
    across = Axis(axis, scale_for(unit, np.concatenate([values, wanted])))
    x, y = time.scaled(times[kept]), across.scaled(values[kept])
    data = [line_trace(x, y, "Computed", "computed", across)]
    if moments.size:
        found = values[np.searchsorted(times, moments)]
        data.append(_published(time.scaled(moments), wanted, found, across))
    for trace in data:
        trace["hovertemplate"] += f"<br>at %{{x:.5~g}} {time.scale.unit}<extra></extra>"
    layout = layout_of(title_of(target), time, across, _extremes(times, values, across, time))
    # Published points lie between samples: a value belongs to the instant of its own point.
    layout["hovermode"] = "closest"
    layout["xaxis"] |= whole_run(response, time)
    layout["showlegend"] = bool(moments.size)
    layout["shapes"] = contact_bands(response, time.scale)
    return {"data": data, "layout": layout}


def _extremes(times: FloatArray, values: FloatArray, axis: Axis, clock: Axis) -> str:
    """Return where a curve is lowest below and highest above zero, in words."""
    rounding = 1e-12 * float(np.max(np.abs(values)))
    found = {"lowest": int(np.argmin(values)), "highest": int(np.argmax(values))}
    told = [
        f"{word} {axis.scale.show(values[at])} {axis.scale.unit} "
        f"at {clock.scale.show(times[at])} {clock.scale.unit}"
        for word, at in found.items()
        if values[at] * (1 if word == "highest" else -1) > rounding
    ]
    text = ", ".join(told) or "zero throughout"
    return text[0].upper() + text[1:]


def _published(x: FloatArray, wanted: FloatArray, found: FloatArray, axis: Axis) -> dict[str, Any]:
    return {
        "type": "scatter",
        "mode": "markers",
        "name": "Published",
        "x": x,
        "y": axis.scaled(wanted),
        "customdata": [_computed(*pair, axis) for pair in zip(wanted, found, strict=True)],
        "cliponaxis": False,
        "marker": {
            "symbol": "circle-open",
            "size": LARGEST_RING,
            "color": LIGHT["published"],
            "line": {"width": 1.6},
        },
        "hovertemplate": f"published %{{y:.5~g}} {axis.scale.unit}<br>computed %{{customdata}}",
    }


def _computed(wanted: float, found: float, axis: Axis) -> str:
    """Return what was computed where a value is published, and how far it is from that."""
    told = f"{axis.scale.show(found)} {axis.scale.unit}"
    return f"{told} ({percent((found - wanted) / abs(wanted), sign=True)})" if wanted else told


def _contact_places(response: Response, node: str, dof: str) -> list[float]:
    """Return the displacements along a dof at which stops facing along it touch."""
    axis = ("dx", "dy", "dz").index(dof) if dof in ("dx", "dy", "dz") else None
    if axis is None:
        return []
    stops = [law for law in fixed_stops(response.problem) if law.coordinate.node == node]
    facing = [(law.gap, law.coordinate.direction[axis]) for law in stops]
    return [-gap / part for gap, part in facing if abs(abs(part) - 1.0) < 1e-12]
