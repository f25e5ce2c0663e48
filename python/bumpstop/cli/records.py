"""Results as the plain objects that ``--json`` prints. Their keys are promised to scripts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from bumpstop.cli.solve import CaseResult, VariantResult
from bumpstop.modal.basis import ModalBasis
from bumpstop.post.references import REFERENCE_QUANTITIES, Check
from bumpstop.response import Response

if TYPE_CHECKING:
    from bumpstop.post.results.reading import Fact, Result

__all__ = ["case_record"]


def case_record(result: CaseResult) -> dict[str, Any]:
    """Return what ``bumpstop run --json`` prints."""
    return {
        "case": result.case.name,
        "variants": [
            _variant_record(
                variant,
                result.case.bases[variant.name],
                result.case.results.get(variant.name, ()),
            )
            for variant in result.variants
        ],
        "passed": result.passed,
    }


def _variant_record(
    variant: VariantResult, basis: ModalBasis, results: Sequence[Result]
) -> dict[str, Any]:
    told = basis if variant.response is None else variant.response.problem
    record = {
        "name": variant.name,
        **(_NOTHING_RUN if variant.response is None else _run_record(variant.response)),
        "references": [_check_record(check) for check in variant.checks],
        "results": _result_records(variant.response, results),
        "remarks": list(told.remarks),
        "passed": variant.passed,
    }
    # Last, since everything read before it is a part of the core's time.
    seconds = 0.0 if variant.response is None else variant.response.solve_seconds
    return record | {"solve_seconds": seconds}


_NOTHING_RUN: dict[str, Any] = {
    "method": None,
    "method_reason": None,
    "steps": 0,
    "certified_steps": None,
    "missed_penetration": None,
    "motion_error": None,
    "events": 0,
    "impacts": 0,
    "energy_residual": None,
}
"""What a modal case has in place of a run."""


def _run_record(response: Response) -> dict[str, Any]:
    return {
        "method": response.method,
        "method_reason": response.method_reason,
        "steps": response.steps,
        "certified_steps": response.certified_steps,
        "missed_penetration": response.missed_penetration,
        "motion_error": response.motion_error,
        "events": response.event_count,
        "impacts": len(response.impact_table()["start"]),
        "energy_residual": response.energy_residual,
    }


def _result_records(response: Response | None, results: Sequence[Result]) -> list[dict[str, Any]]:
    """Return the numbers of what the case asks for; curves are in the report and in files."""
    if response is None or not results:
        return []
    from bumpstop.post.results.reading import read_result

    readings = {result.name: read_result(result, response) for result in results}
    return [
        {
            "name": name,
            "numbers": [_fact_record(fact) for fact in reading.facts],
            "missing": reading.missing or None,
        }
        for name, reading in readings.items()
    ]


def _fact_record(fact: Fact) -> dict[str, Any]:
    return {
        "quantity": fact.what.long_name,
        "units": fact.what.units,
        "value": fact.value,
        "uncertainty": fact.uncertainty,
    }


def _check_record(check: Check) -> dict[str, Any]:
    of = dict(zip(REFERENCE_QUANTITIES[check.quantity], check.target[1:], strict=False))
    if check.mode is not None:
        of = {"mode": check.mode}
    return {
        "quantity": check.quantity,
        **of,
        "time": check.time,
        "value": check.value,
        "reference": check.reference,
        "deviation": check.deviation,
        "tolerance": check.tolerance,
        "passed": check.passed,
    }
