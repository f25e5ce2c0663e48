"""Published against computed values, in words and rows of text."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.post.references import IMPACT_COLUMNS
from bumpstop.quantities import STATISTICS
from bumpstop.report.scales import percent, scale_for, significant, with_unit
from bumpstop.report.words import shown, title_of, unit_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bumpstop.post.references import Check

__all__ = ["Verdict", "deviation_told", "published", "tolerance_told", "verdict", "worst"]


@dataclass(frozen=True)
class Verdict:
    """Whether the published values were met: ``passed``, ``failed`` or ``none``; in words."""

    state: str
    text: str


def verdict(checks: Sequence[Check]) -> Verdict:
    """Return the verdict on some checks."""
    missed = sum(not check.passed for check in checks)
    if not checks:
        return Verdict("none", "No published values to compare with")
    if missed:
        return Verdict("failed", f"{missed} of {len(checks)} published values missed")
    values = f"all {len(checks)} published values" if len(checks) > 1 else "the published value"
    return Verdict("passed", f"Meets {values}")


def worst(checks: Sequence[Check]) -> Check | None:
    """Return the check that comes closest to its tolerance, or goes furthest beyond it."""
    return max(checks, key=lambda check: check.tolerance_used, default=None)


def deviation_told(check: Check, *, sign: bool = False) -> str:
    """Return how far off a computed value is, as fine as the tolerance it is held against."""
    deviation = _signed(check) if sign else check.deviation
    if check.absolute:
        return with_unit(deviation, shown(check.units), 3)
    digits = 2 if check.tolerance == 0.0 else 1 - int(np.floor(np.log10(check.tolerance * 100.0)))
    return percent(deviation, min(max(digits, 2), 9), sign=sign)


def tolerance_told(check: Check) -> str:
    """Return how far off a computed value may be."""
    if check.absolute:
        return with_unit(check.tolerance, shown(check.units), 3)
    return f"{significant(check.tolerance * 100.0, 3, zeros=False)} %"


def published(checks: Sequence[Check]) -> list[dict[str, Any]]:
    """Return the published values beside the computed ones, a group for each quantity.

    Quantities with a single value stand together in a last group, each value with its unit.
    """
    groups: dict[tuple[str | int, ...], list[Check]] = {}
    for check in checks:
        groups.setdefault(check.target, []).append(check)
    series = [_series(some) for some in groups.values() if len(some) > 1]
    single = [some[0] for some in groups.values() if len(some) == 1]
    return [*series, _single_values(single)] if single else series


def _series(checks: Sequence[Check]) -> dict[str, Any]:
    heading, labels = _labels(checks)
    scale = scale_for(_unit(checks[0]), [check.reference for check in checks])
    return {
        "title": title_of(checks[0].target),
        "heading": heading,
        "unit": scale.unit,
        "rows": [
            _row(
                check,
                label,
                significant(check.reference * scale.factor, 6, zeros=False),
                check.missing or scale.show(check.value, 5),
            )
            for label, check in zip(labels, checks, strict=True)
        ],
    }


def _labels(checks: Sequence[Check]) -> tuple[str, list[str]]:
    """Return what tells the values of a series apart: instants, or numbers of modes."""
    if checks[0].mode is not None:
        return "Mode", [str(check.mode) for check in checks]
    clock = scale_for("s", [check.time for check in checks])
    times = [significant(check.time * clock.factor, 6, zeros=False) for check in checks]
    return f"Time ({clock.unit})", times


def _single_values(checks: Sequence[Check]) -> dict[str, Any]:
    rows = []
    for check in checks:
        scale = scale_for(_unit(check), check.reference)
        label = title_of(check.target)
        if check.mode is not None:
            label = f"Natural frequency of mode {check.mode}"
        elif check.quantity not in IMPACT_COLUMNS and check.quantity not in STATISTICS:
            label += f" at {with_unit(check.time, 's', 6)}"
        reference = significant(check.reference * scale.factor, 6, zeros=False)
        value = check.missing or f"{scale.show(check.value, 6)} {scale.unit}"
        rows.append(_row(check, label, f"{reference} {scale.unit}", value))
    return {"title": "Single values", "heading": "Quantity", "unit": "", "rows": rows}


def _unit(check: Check) -> str:
    return unit_of("gauge") if check.quantity == "gauge" else shown(check.units)


def _row(check: Check, label: str, reference: str, value: str) -> dict[str, Any]:
    used = float(np.clip(np.copysign(check.tolerance_used, _signed(check)), -1.0, 1.0))
    return {
        "label": label,
        "reference": reference,
        "value": value,
        "deviation": deviation_told(check, sign=True),
        "tolerance": tolerance_told(check),
        "passed": check.passed,
        "bar_left": f"{50.0 + min(used, 0.0) * 50.0:.1f}",
        "bar_width": f"{abs(used) * 50.0:.1f}",
    }


def _signed(check: Check) -> float:
    """Return how far a computed value lies above (+) or below (-) the published one."""
    return float(np.copysign(check.deviation, check.value - check.reference))
