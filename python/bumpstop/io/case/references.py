"""The references of a case file, each on its variant."""

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
from bumpstop.modal.basis import ModalBasis
from bumpstop.post.references import Reference
from bumpstop.problem import Problem

__all__ = ["build_references"]


def build_references(
    tables: Sequence[ReferenceTable],
    bases: Mapping[str, ModalBasis],
    problems: Mapping[str, Problem],
) -> dict[str, list[Reference]]:
    """Return the references of each variant.

    Raises
    ------
    InputError
        If a reference names what its variant does not have, or its times, values and
        tolerance do not fit together.
    """
    references: dict[str, list[Reference]] = {name: [] for name in bases}
    for number, table in enumerate(tables):
        with keyed(f"references.{number}"):
            for variant in _variants(table, bases):
                reference = _reference(table, bases[variant], problems.get(variant))
                references[variant].append(reference)
    return references


def _variants(table: ReferenceTable, bases: Mapping[str, ModalBasis]) -> list[str]:
    if table.variant is None:
        return list(bases)
    return [one_of("variant", table.variant, tuple(bases))]


def _reference(table: ReferenceTable, basis: ModalBasis, problem: Problem | None) -> Reference:
    # The unit of the values follows from what they are values of, so that comes first.
    target = Reference(
        quantity=table.quantity,
        times=_ascending(table.times or []),
        values=[1.0] * len(table.values),
        tolerance=1.0,
        node=table.node,
        dof=table.dof,
        mode=table.mode,
        modes=table.modes,
        stop=table.stop,
        gauge=table.gauge,
        term=table.term,
        impact=table.impact,
        sampled=table.sampled,
        of_model=table.of_model,
        source=table.source,
    )
    target.check_modes(basis)
    if problem is not None:
        target.check_target(problem)
    elif target.modes is None:
        hint = "without [run] there are frequencies alone"
        raise InputError("is never computed", key="quantity", value=target.quantity, hint=hint)
    return replace(
        target,
        values=[_in_si(f"values.{i}", value, target) for i, value in enumerate(table.values)],
        tolerance=_relative(table),
        absolute_tolerance=_absolute(table, target),
    )


def _relative(table: ReferenceTable) -> float | None:
    if table.tolerance is None:
        return table.relative_tolerance
    if table.relative_tolerance is not None:
        what = "is the same as tolerance"
        value = table.relative_tolerance
        raise InputError(what, key="relative_tolerance", value=value, hint="give one of them")
    return table.tolerance


def _absolute(table: ReferenceTable, target: Reference) -> float | None:
    if table.absolute_tolerance is None:
        return None
    return _in_si("absolute_tolerance", table.absolute_tolerance, target, above=0.0)


def _in_si(key: str, value: float | str, target: Reference, above: float | None = None) -> float:
    unit = "" if target.units == "1" else target.units
    dimension = Dimension(f"a {target.quantity}".replace("_", " "), unit, f"1 {unit}")
    with keyed(key):
        return read_number(value, dimension, above=above)


def _ascending(times: Sequence[float]) -> Sequence[float]:
    for number, (earlier, later) in enumerate(pairwise(times), start=1):
        if later <= earlier:
            raise InputError("times must ascend", key=f"times.{number}", value=later)
    return times
