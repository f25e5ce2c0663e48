"""What stands on the page that compares several runs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from bumpstop import __version__
from bumpstop.errors import InputError
from bumpstop.report import overlays, tables
from bumpstop.report.palette import DARK, LIGHT
from bumpstop.report.scales import percent, scale_for
from bumpstop.report.variant import MOST_STOPS, caption, untitled, watched_places
from bumpstop.report.words import title_of, unit_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from bumpstop.arguments import FloatArray
    from bumpstop.report.figures import Figure
    from bumpstop.response import Response

__all__ = ["comparison_content"]

ROUNDING = 1e-12
"""Values that differ by less than this, relative to the larger, are told as the same."""


class Row(NamedTuple):
    """A quantity with its value in each run."""

    label: str
    unit: str
    values: Sequence[float]


def comparison_content(
    responses: Mapping[str, Response],
) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return what the template fills in, and the data that the page's scripts read.

    Parameters
    ----------
    responses
        The runs by name, two or more; what they have in common is compared, each with the first.

    Raises
    ------
    InputError
        If there are fewer than two.
    """
    if len(responses) < 2:
        raise InputError("takes two runs or more", key="responses", value=list(responses))
    solve_seconds = {name: response.solve_seconds for name, response in responses.items()}
    figures = {
        f"figure-{number}": figure for number, figure in enumerate(_figures(responses), start=1)
    }
    first, *others = responses
    content = {
        "title": f"{first} beside {', '.join(others)}",
        "description": "",
        "case_name": "comparison",
        "version": __version__,
        "verdict": {"state": "none", "text": f"{len(responses)} runs, each compared with {first}"},
        "facts": tables.facts(responses, {}, solve_seconds),
        "overview": tables.overview(responses, {}, solve_seconds),
        "methods": tables.methods(responses),
        "model": tables.model({name: each.problem for name, each in responses.items()}),
        "runs": list(responses),
        "groups": [
            {"title": title, "rows": [_told(row) for row in rows]}
            for title, rows in _groups(responses)
        ],
        "figures": [caption(name, figure) for name, figure in figures.items()],
    }
    data = {
        "themes": {"light": LIGHT, "dark": DARK},
        "figures": {name: untitled(figure) for name, figure in figures.items()},
        "motions": {},
        "modes": {},
    }
    return content, data


def _figures(responses: Mapping[str, Response]) -> Iterator[Figure]:
    for place in _common_places(responses):
        yield overlays.quantity_overlay(responses, ("displacement", *place))
    for stop in _common_stops(responses):
        yield overlays.quantity_overlay(responses, ("stop_force", stop))
        yield overlays.quantity_overlay(responses, ("gap", stop))
    for title in overlays.ENERGIES:
        yield overlays.energy_overlay(responses, title)


def _common_places(responses: Mapping[str, Response]) -> list[tuple[str, str]]:
    """Return the watched nodes and dofs of the first run that all runs know."""
    first = next(iter(responses.values()))
    return [
        place
        for place in watched_places(first.problem, [])
        if all(_knows(response, *place) for response in responses.values())
    ]


def _knows(response: Response, node: str, dof: str) -> bool:
    try:
        response.problem.basis.row(node, dof)
    except InputError:
        return False
    return True


def _common_stops(responses: Mapping[str, Response]) -> list[str]:
    named = [[law.name for law in each.problem.laws] for each in responses.values()]
    return [name for name in named[0] if all(name in names for names in named)][:MOST_STOPS]


def _groups(responses: Mapping[str, Response]) -> Iterator[tuple[str, list[Row]]]:
    """Yield the tables: a title, and a row a quantity."""
    runs = list(responses.values())
    for place in _common_places(responses):
        target = ("displacement", *place)
        found = [_extremes(response, target) for response in runs]
        unit = unit_of("displacement", place[1])
        yield title_of(target), _rows(found, dict.fromkeys(found[0], unit))
    for stop in _common_stops(responses):
        yield f"Contact at {stop}", _rows([_contact(run, stop) for run in runs], CONTACT_UNITS)
    found = [_energies(response) for response in runs]
    yield "Energy at the end of the run", _rows(found, dict.fromkeys(found[0], "J"))


def _rows(found: Sequence[Mapping[str, float]], units: Mapping[str, str]) -> list[Row]:
    return [Row(label, unit, [each[label] for each in found]) for label, unit in units.items()]


def _extremes(response: Response, target: tuple[str, ...]) -> dict[str, float]:
    from bumpstop.report.curves import instants

    values: FloatArray = response.sample(*target, times=instants(response))
    return {
        "Lowest": float(values.min()),
        "Highest": float(values.max()),
        "At the end": float(values[-1]),
    }


CONTACT_UNITS = {
    "Impacts": "",
    "Impacts a second": "Hz",
    "Part of the time in contact": "%",
    "Mean contact": "s",
    "Largest force": "N",
    "Mean peak force": "N",
    "Mean closing speed": "m/s",
    "Largest closing speed": "m/s",
    "Impulse of all": "N s",
    "Energy returned by all": "J",
}
"""What is told of the contact at a stop, with units."""


def _contact(response: Response, stop: str) -> dict[str, float]:
    """Return what the table of impacts tells of a stop, of which files have all."""
    table = response.impact_table()
    own = [name == stop for name in table["stop"]]
    column = {
        name: np.array(table[name], dtype=float)[own]
        for name in table
        if name not in ("stop", "peak_time")
    }
    duration = response.problem.duration
    lasting = np.where(np.isnan(column["end"]), duration, column["end"]) - column["start"]
    return {
        "Impacts": float(len(lasting)),
        "Impacts a second": len(lasting) / duration,
        "Part of the time in contact": 100.0 * float(lasting.sum()) / duration,
        "Mean contact": _mean(lasting),
        "Largest force": _largest(column["peak_force"]),
        "Mean peak force": _mean(column["peak_force"]),
        "Mean closing speed": _mean(column["closing_speed"]),
        "Largest closing speed": _largest(column["closing_speed"]),
        "Impulse of all": float(column["impulse"].sum()),
        "Energy returned by all": float(column["energy_returned"].sum()),
    }


def _mean(values: FloatArray) -> float:
    return float(values.mean()) if len(values) else math.nan


def _largest(values: FloatArray) -> float:
    return float(values.max()) if len(values) else math.nan


def _energies(response: Response) -> dict[str, float]:
    ledger = response.energy_terms(response.instants[-1:])
    named = {
        "Kinetic": "kinetic",
        "Elastic": "elastic",
        "In stops": "stored",
        "Lost to damping": "dissipated_damping",
        "Lost in stops": "dissipated_stops",
        "Work of the loads": "load_work",
        "Initial": "total_initial",
    }
    return {label: float(ledger[term][0]) for label, term in named.items()}


def _told(row: Row) -> dict[str, Any]:
    """Return a row in words: the values, and how each differs from the first."""
    scale = scale_for(row.unit, list(row.values)) if row.unit not in ("", "%") else None
    factor, unit = (scale.factor, scale.unit) if scale else (1.0, row.unit)
    whole = not row.unit

    def number(value: float, sign: str = "") -> str:
        if not math.isfinite(value):
            return "–"
        text = f"{value * factor:{sign},.0f}" if whole else f"{value * factor:{sign}.5g}"
        return text.replace("-", "−")

    def difference(value: float) -> str:
        apart = value - first
        if not math.isfinite(apart):
            return ""
        if abs(apart) <= ROUNDING * max(abs(value), abs(first)):
            return "the same"
        return number(apart, "+") + (
            f" ({percent(apart / abs(first), sign=True)})" if first else ""
        )

    first, *others = row.values
    cells = [{"value": number(value), "difference": difference(value)} for value in others]
    return {
        "label": f"{row.label} ({unit})" if unit else row.label,
        "first": number(first),
        "others": cells,
    }
