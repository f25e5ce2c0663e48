"""How wrong a case's results are, on the page: words, tables and figures."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.report.plotting import Axis, layout_of, line_trace
from bumpstop.report.scales import Scale, scale_for, significant
from bumpstop.report.words import shown, title_of

if TYPE_CHECKING:
    from bumpstop.report.figures import Figure
    from bumpstop.study.convergence import Convergence, Ladder, VariantConvergence

__all__ = ["add_convergence", "error_figure", "ladder_told", "position_told", "remedy_told"]

_SIZES = {
    "time": ("Error of time", "Step (s)"),
    "basis": ("Error of the basis", "Vectors of the basis"),
    "mesh": ("Error of the mesh", "Elements in the place of one"),
}
"""Title of a figure, and what its sizes are."""


def add_convergence(
    found: Convergence, content: dict[str, Any], data: dict[str, Any], *, drawn: bool = True
) -> None:
    """Add what a study of convergence found to a page's content, and its figures to the data."""
    content["convergence"] = []
    for number, variant in enumerate(found.variants.values(), start=1):
        identity = f"convergence-{number}"
        figures = [
            (f"{identity}-{ladder.part}", error_figure(variant, ladder))
            for ladder in variant.ladders
            if drawn and len(ladder.rungs) > 1
        ]
        told = [f"{each.part.capitalize()}: {ladder_told(each)}." for each in variant.ladders]
        content["convergence"].append(
            {
                "id": identity,
                "name": variant.name,
                "position": f"{position_told(variant)}.".replace("+-", "±").replace("-", "−"),
                "groups": [*_groups(variant)],
                "told": [*told, *(f"{line}." for line in remedy_told(variant))],
                "figures": [_caption(name, figure) for name, figure in figures],
            }
        )
        data["figures"] |= {name: _untitled(figure) for name, figure in figures}


def error_figure(variant: VariantConvergence, ladder: Ladder) -> Figure:
    """Draw how far refined values are from their limit, and from the published ones.

    Parameters
    ----------
    variant
        Whose values.
    ladder
        One of its sources of error, refined at least once.
    """
    title, across = _SIZES[ladder.part]
    x = Axis(across, Scale(1.0, ""))
    y = Axis("Root mean square deviation", Scale(100.0, "%"))
    sizes = np.array([rung.size for rung in ladder.rungs])
    towards = {
        "From their limit": (ladder.limits, "computed"),
        "From the published values": (variant.published, "contact"),
    }
    data = []
    for name, (limit, role) in towards.items():
        distances = [variant.relative(rung.values - limit) for rung in ladder.rungs]
        kept = np.array(distances) > 0.0  # the last rung may be its own limit
        trace = line_trace(sizes[kept], y.scaled(np.array(distances)[kept]), name, role, y)
        data.append(trace | {"mode": "lines+markers"})
    layout = layout_of(title, x, y, "Both axes logarithmic; relative to the published values")
    layout["hovermode"] = "closest"
    layout["yaxis"] |= {"type": "log", "exponentformat": "power"}
    ticks = {
        "tickvals": sizes.tolist(),
        "ticktext": [rung.label for rung in ladder.rungs],
        "tickangle": 0,
    }
    layout["xaxis"] |= {"type": "log", **ticks}
    layout["xaxis"]["title"]["text"] = across
    return {"data": data, "layout": layout}


def ladder_told(ladder: Ladder) -> str:
    """Return what was done about one source of error, with the order where one is to be seen."""
    if not ladder.rungs:
        return ladder.told
    orders = ladder.order[np.isfinite(ladder.order)]
    if not len(orders):
        return f"{ladder.told}; no order to be seen"
    low, high = (f"{order:.1f}" for order in (orders.min(), orders.max()))
    order = low if low == high else f"{low} to {high}"
    values = len(ladder.order)
    where = "" if len(orders) == values else f", irregular for {values - len(orders)} of {values}"
    return f"{ladder.told}; order {order}{where}"


def position_told(variant: VariantConvergence) -> str:
    """Return whether the published values are those of the model or of what it converges to."""
    position = variant.position
    if position is None:
        return _untold(variant)
    part = variant.largest
    of = {"time": "of this step", "basis": f"of {variant.vectors} modes", "mesh": "of this mesh"}
    where = (
        f"{position.share:.2g} +- {position.error:.2g} of the way "
        "from the computed to the converged values"
    )
    are = "are those" if position.is_firm else "are rather those"
    match position.verdict:
        case "computed":
            than = ", not" if position.is_firm else " than"
            ends = f"{of[part]}{than} of the structure itself"
            return f"The published values {are} {ends}: {where}"
        case "converged":
            return f"The published values {are} of the structure itself: {where}"
        case "other":
            return f"The published values are neither computed nor converged ones: {where}"
    return f"The published values do not tell this model from a finer one: {where}"


def _untold(variant: VariantConvergence) -> str:
    """Return how far published values are from both, where no regression can tell more."""
    number = int(np.count_nonzero(variant.outside))
    if not number:
        return "No value from outside that could tell this model from a finer one"
    computed, converged = (f"{100.0 * distance:.2g} %" for distance in variant.distances)
    values = "one value" if number == 1 else f"{number} values"
    return (
        f"Nothing that could tell this model from a finer one: {values} from outside, "
        f"{computed} off the computed and {converged} off the converged ones, root mean square"
    )


def remedy_told(variant: VariantConvergence) -> Iterator[str]:
    """Yield what static shapes would leave of the basis' error, where they help."""
    if variant.remedy is None:
        return
    left, now = variant.relative(variant.remedy.error), variant.relative(variant.basis.error)
    if left < now:
        yield f"{variant.remedy.told} would leave {100.0 * left / now:.2g} % of the basis' error"


def _groups(variant: VariantConvergence) -> Iterator[dict[str, Any]]:
    """Yield the rows of each quantity, in a unit that suits its values."""
    rows = range(len(variant.checks))
    for target, group in groupby(rows, lambda row: variant.checks[row].target):
        numbers = list(group)
        checks = [variant.checks[row] for row in numbers]
        units = shown(checks[0].units)
        scale = scale_for("" if units == "1" else units, variant.published[numbers])
        clock = scale_for("s", [check.time for check in checks])
        modes = checks[0].mode is not None
        yield {
            "title": title_of(target) + (f" ({scale.unit})" if scale.unit else ""),
            "heading": "Mode" if modes else f"Time ({clock.unit})",
            "rows": [_row(variant, row, scale, clock) for row in numbers],
        }


def _row(variant: VariantConvergence, row: int, scale: Scale, clock: Scale) -> list[str]:
    check = variant.checks[row]
    errors = [ladder.error[row] for ladder in variant.ladders]
    return [
        clock.show(check.time) if check.mode is None else str(check.mode),
        significant(check.reference * scale.factor, 6, zeros=False),
        scale.show(check.value, 6),
        *(scale.show(error, 2) for error in errors),
        scale.show(variant.converged[row], 6),
        scale.show(variant.uncertainty[row], 1),
    ]


def _caption(name: str, figure: Figure) -> dict[str, str]:
    layout = figure["layout"]
    across, up = (layout[axis]["title"]["text"] for axis in ("xaxis", "yaxis"))
    return {
        "id": name,
        "title": layout["title"]["text"],
        "note": layout["title"]["subtitle"]["text"],
        "label": f"Plot of {up} against {across}",
    }


def _untitled(figure: Figure) -> Figure:
    layout = {key: value for key, value in figure["layout"].items() if key != "title"}
    return {"data": figure["data"], "layout": layout | {"margin": layout["margin"] | {"t": 40}}}
