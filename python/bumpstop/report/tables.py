"""The tables of the report, as rows of text."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.laws import Stop
from bumpstop.modal.basis import COMBINATION
from bumpstop.quantities import IMPACTS
from bumpstop.report.balance import ledger_instants, residual_told
from bumpstop.report.published import deviation_told, tolerance_told, verdict, worst
from bumpstop.report.scales import percent, power_of_ten, scale_for, significant, with_unit
from bumpstop.report.summary import Row, basis_rows, method_words, model_rows
from bumpstop.report.words import shown

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from bumpstop.modal.basis import ModalBasis
    from bumpstop.post.references import Check
    from bumpstop.post.results.reading import Reading
    from bumpstop.problem import Problem
    from bumpstop.response import Response

__all__ = [
    "facts",
    "impacts",
    "methods",
    "modal_facts",
    "modal_model",
    "model",
    "modes",
    "overview",
    "results",
    "variant_notes",
]

MOST_IMPACTS = 50
"""Rows of the impact table; the response's file has them all."""

_SOLVED_COLUMNS = (
    "Variant",
    "Method",
    "Steps",
    "Events",
    "Impacts",
    "Peak force",
    "Energy residual",
    "Core time",
)
_PUBLISHED_COLUMNS = ("Worst deviation", "Published values")

_IMPACT_COLUMNS = (
    ("start", "Closes"),
    ("end", "Opens"),
    ("duration", "Contact"),
    ("closing_speed", "Closing speed"),
    ("opening_speed", "Opening speed"),
    ("peak_force", "Peak force"),
    ("peak_time", "Peak at"),
    ("impulse", "Impulse"),
    ("energy_returned", "Energy returned"),
)


def facts(
    responses: Mapping[str, Response],
    checks: Mapping[str, Sequence[Check]],
    solve_seconds: Mapping[str, float],
) -> list[dict[str, str]]:
    """Return the few numbers at the head of the page: name, value and note of each."""
    told = _checked(checks)
    bounds = [r.missed_penetration for r in responses.values() if r.problem.laws]
    proved = [bound for bound in bounds if bound is not None]
    if proved and len(proved) == len(bounds):
        told.append(("Missed contacts", "none", f"deeper than {power_of_ten(max(proved))} m"))
    residual = max(response.energy_residual for response in responses.values())
    moments = {ledger_instants(response) for response in responses.values()}
    note = ", ".join(["of the largest energy", *(moments if len(moments) == 1 else ())])
    told.append(("Energy residual", residual_told(residual), note))
    runs = len(responses)
    seconds = with_unit(sum(solve_seconds.values()), "s", 3)
    told.append(("Solved in", seconds, f"core time, {runs} runs" if runs > 1 else "core time"))
    return _named(told)


def modal_facts(
    bases: Mapping[str, ModalBasis], checks: Mapping[str, Sequence[Check]]
) -> list[dict[str, str]]:
    """Return the few numbers at the head of the page of a modal case."""
    different = list(dict.fromkeys(bases.values()))
    elastic = [hertz for basis in different for hertz in basis.frequencies if hertz > 0.0]
    models = f"of {len(different)} models together" if len(different) > 1 else ""
    told = [*_checked(checks), ("Modes", f"{sum(len(b.omega2) for b in different):,}", models)]
    rigid = sum(len(basis.rigid_modes) for basis in different)
    if rigid:
        told.append(("Rigid modes", f"{rigid:,}", models))
    if elastic:
        beside = "beside the rigid modes" if rigid else ""
        told.append(("Lowest frequency", with_unit(min(elastic), "Hz"), beside))
        told.append(("Highest frequency", with_unit(max(elastic), "Hz"), ""))
    return _named(told)


def _checked(checks: Mapping[str, Sequence[Check]]) -> list[tuple[str, str, str]]:
    """Return how many published values were met, and how closely."""
    every = [check for some in checks.values() for check in some]
    furthest = worst(every)
    if furthest is None:
        return []
    met = sum(check.passed for check in every)
    allowed = f"{tolerance_told(furthest)} allowed"
    return [
        ("Published values met", f"{met} of {len(every)}", ""),
        ("Worst against its tolerance", deviation_told(furthest), allowed),
    ]


def _named(told: Sequence[tuple[str, str, str]]) -> list[dict[str, str]]:
    return [{"name": name, "value": value, "note": note} for name, value, note in told]


def overview(
    responses: Mapping[str, Response],
    checks: Mapping[str, Sequence[Check]],
    solve_seconds: Mapping[str, float],
) -> dict[str, Any]:
    """Return one row a variant: how it was solved and how it came out.

    What is published comes last, where anything is.
    """
    published = any(checks.values())
    rows = []
    for name, response in responses.items():
        table = response.impact_table()
        some = checks.get(name, [])
        forces = np.array(table["peak_force"], dtype=float)
        cells = [
            method_words(response)[0],
            f"{response.steps:,}",
            f"{response.event_count:,}",
            f"{len(table['start']):,}",
            with_unit(float(forces.max()), "N") if forces.size else "–",
            residual_told(response.energy_residual),
            with_unit(solve_seconds[name], "s", 3),
        ]
        row: dict[str, Any] = {"name": name, "cells": cells, "state": "none", "verdict": ""}
        if published:
            furthest = worst(some)
            met = sum(check.passed for check in some)
            cells.append("–" if furthest is None else _of_tolerance(furthest))
            row["state"] = verdict(some).state
            row["verdict"] = f"{met} of {len(some)} met" if some else "none"
        rows.append(row)
    columns = _SOLVED_COLUMNS + (_PUBLISHED_COLUMNS if published else ())
    return {"columns": columns, "rows": rows}


def methods(responses: Mapping[str, Response]) -> list[dict[str, str]]:
    """Return the methods used, with what they are and why they were taken."""
    users: dict[tuple[str, str], list[str]] = {}
    for name, response in responses.items():
        users.setdefault(method_words(response), []).append(name)
    alone = len(users) == 1
    return [
        {"name": name, "text": text, "variants": "" if alone else ", ".join(variants)}
        for (name, text), variants in users.items()
    ]


def model(problems: Mapping[str, Problem]) -> list[dict[str, Any]]:
    """Return the model, one row a subject; where variants differ, each says its own."""
    return _side_by_side({name: model_rows(problem) for name, problem in problems.items()})


def modal_model(bases: Mapping[str, ModalBasis]) -> list[dict[str, Any]]:
    """Return the model of a modal case, as `model` does."""
    return _side_by_side({name: basis_rows(basis) for name, basis in bases.items()})


def _side_by_side(variants: Mapping[str, Sequence[Row]]) -> list[dict[str, Any]]:
    told = {name: dict(rows) for name, rows in variants.items()}
    terms = list(dict.fromkeys(term for rows in told.values() for term in rows))
    table = []
    for term in terms:
        texts = {name: rows.get(term, ["none"]) for name, rows in told.items()}
        first = next(iter(texts.values()))
        if all(lines == first for lines in texts.values()):
            lines = [{"variant": "", "text": text} for text in first]
        else:
            lines = [
                {"variant": name, "text": text} for name, some in texts.items() for text in some
            ]
        table.append({"term": term, "lines": lines})
    return table


def variant_notes(problems: Mapping[str, Problem]) -> dict[str, str]:
    """Return what sets each variant's stops apart, in a few words; empty where nothing does.

    Only numbers of stops that all variants have are told.
    """
    units = {"gap": "m", "stiffness": "N/m", "damping": "N s/m"}
    told: dict[str, list[str]] = {name: [] for name in problems}
    laws = {
        name: {law.name: law for law in problem.laws if isinstance(law, Stop)}
        for name, problem in problems.items()
    }
    common = set.intersection(*(set(some) for some in laws.values()))
    first = next(iter(problems.values()))
    for law in [law for law in first.laws if law.name in common and isinstance(law, Stop)]:
        for field in fields(law):
            values = {name: getattr(laws[name][law.name], field.name) for name in problems}
            if field.name in units and len(set(values.values())) > 1:
                for name, value in values.items():
                    told[name].append(f"{field.name} {with_unit(value, units[field.name])}")
    return {name: ", ".join(notes) for name, notes in told.items()}


def impacts(response: Response) -> dict[str, Any]:
    """Return the impact table, its first rows where there are many."""
    table = response.impact_table()
    count = len(table["start"])
    scales = {}
    for name, _ in _IMPACT_COLUMNS:
        clock = name in ("start", "end", "peak_time")
        values = [response.problem.duration] if clock else table[name]
        scales[name] = scale_for(IMPACTS[name].units, values)
    rows = [
        {
            "stop": table["stop"][row],
            "cells": [scales[name].show(float(table[name][row]), 5) for name, _ in _IMPACT_COLUMNS],
        }
        for row in range(min(count, MOST_IMPACTS))
    ]
    columns = [f"{heading} ({scales[name].unit})" for name, heading in _IMPACT_COLUMNS]
    more = count - len(rows)
    return {"columns": columns, "rows": rows, "more": f"{more:,}" if more else ""}


def results(readings: Mapping[str, Reading]) -> list[dict[str, Any]]:
    """Return the numbers of the results that a case asks for, a table for each."""
    told = []
    for name, reading in readings.items():
        rows = [
            {
                "label": fact.what.long_name[:1].upper() + fact.what.long_name[1:],
                "value": _told(fact.value, fact.what.units),
                "uncertainty": _told(fact.uncertainty, fact.what.units),
            }
            for fact in reading.facts
        ]
        uncertain = any(np.isfinite(fact.uncertainty) for fact in reading.facts)
        if rows or reading.missing:
            missing = reading.missing
            told.append({"name": name, "rows": rows, "uncertain": uncertain, "missing": missing})
    return told


def _told(value: float, units: str) -> str:
    # Prefixes are for plain units; a rate or a volume is told as it is.
    if units.isalpha() and np.isfinite(value):
        return with_unit(value, units)
    number = significant(value, 4, zeros=False)
    return number if units == "1" or not np.isfinite(value) else f"{number} {shown(units)}"


def modes(basis: ModalBasis, seen: Sequence[bool] | None = None) -> list[dict[str, str]]:
    """Return frequency in Hz and damping of each mode, and a title that tells it.

    The title of a mode that is not `seen`, as it moves no point, says so.
    """
    told = zip(basis.frequencies.tolist(), basis.damping_ratio.tolist(), strict=True)
    rows = []
    for number, (hertz, ratio) in enumerate(told):
        # A ratio of critical damping says nothing of a mode without stiffness.
        frequency, damping = significant(hertz, 6), percent(ratio)
        title = f"{significant(hertz, 5)} Hz"
        if hertz <= 0.0:
            frequency = title = "rigid" if hertz == 0.0 else "unstable"
            damping = "–"
        if seen is not None and not seen[number]:
            title += ", rotations alone, which lines do not show"
        rows.append(
            {
                "frequency": frequency,
                "damping": damping,
                "title": f"{_mode_name(basis, number)}: {title}",
            }
        )
    return rows


def _mode_name(basis: ModalBasis, number: int) -> str:
    label = basis.canonical_labels[number]
    return f"{label[0].upper()}{label[1:]}" if label != COMBINATION else f"Mode {number + 1}"


def _of_tolerance(check: Check) -> str:
    return f"{deviation_told(check)} of {tolerance_told(check)}"
