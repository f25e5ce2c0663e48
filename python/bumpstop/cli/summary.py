"""What ``bumpstop run`` tells a person."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from math import isfinite, isnan
from pathlib import Path
from typing import Any

from bumpstop.cli.console import Table, print_line, print_table
from bumpstop.cli.outputs import older_outputs
from bumpstop.cli.solve import CaseResult, VariantResult
from bumpstop.methods import ASKED
from bumpstop.post.energy import residual_told
from bumpstop.post.references import Check
from bumpstop.report.words import title_of
from bumpstop.response import Response

__all__ = ["print_summary", "print_written", "verdict"]


def print_summary(result: CaseResult, record: dict[str, Any]) -> None:
    """Print, for each variant, published against computed values and how the run went.

    Parameters
    ----------
    result
        What was computed.
    record
        The same as `case_record` gives it.
    """
    print_line(result.case.title, style="bold")
    for variant, numbers in zip(result.variants, record["variants"], strict=True):
        print_line()
        print_line(variant.name, style="bold cyan")
        for caption, table in _tables(variant):
            print_line(f"  {caption}")
            print_table(table)
        for told in numbers["results"]:
            if told["numbers"]:
                print_line(f"  {told['name']}")
                print_table(_numbers_table(told["numbers"]))
        for line in [*numbers["remarks"], *_told(variant.response, numbers)]:
            print_line(f"  {line}")
        print_line(f"  {verdict(variant.checks)}", style="green" if variant.passed else "bold red")


def print_written(folder: Path, names: Sequence[str]) -> None:
    """Print where files were written, and what an earlier run has left there."""
    print_line()
    older = older_outputs(folder, names)
    if older:
        print_line(f"of an earlier run, left as they were: {', '.join(older)}", style="yellow")
    print_line(f"written to {folder}")


def verdict(checks: list[Check]) -> str:
    """Return how many checks passed, in words."""
    if not checks:
        return "no references to check"
    passed = sum(check.passed for check in checks)
    if passed == len(checks):
        return f"all {passed} checks passed" if passed > 1 else "the check passed"
    return f"{len(checks) - passed} of {len(checks)} checks FAILED"


def _told(response: Response | None, numbers: dict[str, Any]) -> Iterator[str]:
    """Yield what is to be said of a run."""
    if response is None:
        return
    yield _how(numbers)
    if numbers["method_reason"] != ASKED:
        yield f"auto took this method: {numbers['method_reason']}"
    if response.problem.laws and numbers["certified_steps"] is not None:
        yield _certificate(numbers)


def _how(numbers: dict[str, Any]) -> str:
    return (
        f"method {numbers['method']}, {_many(numbers['steps'], 'step')}, "
        f"{_many(numbers['events'], 'event')}, {_many(numbers['impacts'], 'impact')}, "
        f"energy residual {residual_told(numbers['energy_residual'])}, "
        f"solved in {_duration(numbers['solve_seconds'])}"
    )


def _certificate(numbers: dict[str, Any]) -> str:
    depth, error = numbers["missed_penetration"], numbers["motion_error"]
    missed = f"certified: no contact deeper than {depth:.1e} m missed"
    if not isfinite(error):
        return missed
    return f"{missed}, motion true to {error:.1e} m between switches"


def _many(count: int, thing: str) -> str:
    return f"{count:,} {thing}{'' if count == 1 else 's'}"


def _duration(seconds: float) -> str:
    for size, unit in ((1.0, "s"), (1e-3, "ms")):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds * 1e6:.3g} us"


def _tables(variant: VariantResult) -> Iterator[tuple[str, Table]]:
    """Yield a caption and a table for each thing that is checked."""
    for (target, units), checks in groupby(
        variant.checks, lambda check: (check.target, check.units)
    ):
        unit = "" if units == "1" else f", in {units}"
        yield f"{title_of(target)}{unit}", _table(list(checks))


def _table(checks: list[Check]) -> Table:
    return Table(
        headers=(
            "time [s]" if checks[0].mode is None else "mode",
            "published",
            "computed",
            "deviation",
            "tolerance",
            "ok",
        ),
        rows=[_row(check) for check in checks],
        good=[check.passed for check in checks],
    )


def _numbers_table(numbers: Sequence[dict[str, Any]]) -> Table:
    """Return the numbers of a result, with their uncertainty where some has one."""
    uncertain = any(isfinite(each["uncertainty"]) for each in numbers)
    rows = []
    for each in numbers:
        unit = "" if each["units"] == "1" else each["units"]
        cells = [each["quantity"], _number(each["value"])]
        rows.append([*cells, *([_number(each["uncertainty"])] if uncertain else []), unit])
    headers = ["", "value", *(["uncertainty"] if uncertain else []), "unit"]
    return Table(headers, rows, labels=1)


def _row(check: Check) -> tuple[str, ...]:
    return (
        _number(check.time) if check.mode is None else str(check.mode),
        _number(check.reference),
        check.missing or _number(check.value),
        _deviation(check.deviation, check.absolute),
        _deviation(check.tolerance, check.absolute),
        "yes" if check.passed else "NO",
    )


def _number(value: float) -> str:
    return "-" if isnan(value) else f"{value:.6g}"


def _deviation(value: float, absolute: bool) -> str:
    if isnan(value):
        return "-"
    return f"{value:.3g}" if absolute else f"{100 * value:.3g} %"
