"""The references of a case file, each on the problem of its variant."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

from bumpstop.arguments import one_of
from bumpstop.errors import InputError
from bumpstop.io.case.fields.quantities import read_number
from bumpstop.io.case.keys import keyed
from bumpstop.io.case.tables.references import ReferenceTable
from bumpstop.io.units import Dimension
from bumpstop.post.references import Reference
from bumpstop.problem import Problem

__all__ = ["build_references"]


def build_references(
    tables: Sequence[ReferenceTable], problems: Mapping[str, Problem]
) -> dict[str, list[Reference]]:
    """Return the references of each variant.

    Raises
    ------
    InputError
        If a reference names what its problem does not have, or its times, values and
        tolerance do not fit together.
    """
    references: dict[str, list[Reference]] = {name: [] for name in problems}
    for number, table in enumerate(tables):
        with keyed(f"references.{number}"):
            for variant in _variants(table, problems):
                references[variant].append(_reference(table, problems[variant]))
    return references


def _variants(table: ReferenceTable, problems: Mapping[str, Problem]) -> list[str]:
    if table.variant is None:
        return list(problems)
    return [one_of("variant", table.variant, tuple(problems))]


def _reference(table: ReferenceTable, problem: Problem) -> Reference:
    # The unit of the values follows from what they are values of, so that comes first.
    target = Reference(
        quantity=table.quantity,
        times=_ascending(table.times or [], problem.duration),
        values=[1.0] * len(table.values),
        tolerance=1.0,
        node=table.node,
        dof=table.dof,
        mode=table.mode,
        stop=table.stop,
        gauge=table.gauge,
        term=table.term,
        impact=table.impact,
        source=table.source,
    )
    _check_target(target, problem)
    return replace(
        target,
        values=[_in_si(f"values.{i}", value, target) for i, value in enumerate(table.values)],
        tolerance=table.tolerance,
        absolute_tolerance=_absolute(table, target),
    )


def _absolute(table: ReferenceTable, target: Reference) -> float | None:
    if table.absolute_tolerance is None:
        return None
    return _in_si("absolute_tolerance", table.absolute_tolerance, target, above=0.0)


def _in_si(key: str, value: float | str, target: Reference, above: float | None = None) -> float:
    unit = "" if target.units == "1" else target.units
    dimension = Dimension(f"a {target.quantity}".replace("_", " "), unit, f"1 {unit}")
    with keyed(key):
        return read_number(value, dimension, above=above)


def _ascending(times: Sequence[float], duration: float) -> Sequence[float]:
    for number, (earlier, later) in enumerate(pairwise(times), start=1):
        if later <= earlier:
            raise InputError("times must ascend", key=f"times.{number}", value=later)
    if times and times[-1] > duration:
        raise InputError(
            "is after the end of the run",
            key=f"times.{len(times) - 1}",
            value=times[-1],
            hint=f"run.duration is {duration:g} s",
        )
    return times


def _check_target(reference: Reference, problem: Problem) -> None:
    """Raise where the problem has no such node, stop, gauge or mode."""
    if reference.node is not None:
        problem.basis.row(reference.node, str(reference.dof))
    if reference.stop is not None:
        one_of("stop", reference.stop, [law.name for law in problem.laws])
    if reference.gauge is not None:
        one_of("gauge", reference.gauge, [gauge.name for gauge in problem.gauges])
    modes = len(problem.basis.labels)
    if reference.mode is not None and reference.mode > modes:
        raise InputError(f"must be at most {modes}", key="mode", value=reference.mode)
