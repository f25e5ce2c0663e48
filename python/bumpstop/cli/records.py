"""Results as the plain objects that ``--json`` prints. Their keys are promised to scripts."""

from __future__ import annotations

from typing import Any

from bumpstop.cli.solve import CaseResult, VariantResult
from bumpstop.post.references import Check

__all__ = ["case_record"]


def case_record(result: CaseResult) -> dict[str, Any]:
    """Return what ``bumpstop run --json`` prints."""
    return {
        "case": result.case.name,
        "variants": [_variant_record(variant) for variant in result.variants],
        "passed": result.passed,
    }


def _variant_record(variant: VariantResult) -> dict[str, Any]:
    response = variant.response
    record = {
        "name": variant.name,
        "method": response.method,
        "steps": response.steps,
        "certified_steps": response.certified_steps,
        "missed_penetration": response.missed_penetration,
        "events": response.event_count,
        "impacts": len(response.impact_table()["start"]),
        "energy_residual": response.energy_residual,
        "references": [_check_record(check) for check in variant.checks],
        "passed": variant.passed,
    }
    # Last, since everything read before it is a part of the core's time.
    return record | {"solve_seconds": response.solve_seconds}


def _check_record(check: Check) -> dict[str, Any]:
    return {
        "quantity": check.quantity,
        "time": check.time,
        "value": check.value,
        "reference": check.reference,
        "deviation": check.deviation,
        "tolerance": check.tolerance,
        "passed": check.passed,
    }
