"""``bumpstop verify``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from bumpstop.arguments import one_of
from bumpstop.cli.console import Table, print_json, print_line, print_table
from bumpstop.cli.progress import progress_display
from bumpstop.cli.records import case_record
from bumpstop.cli.solve import CaseResult, VariantResult, solve_case
from bumpstop.cli.summary import verdict
from bumpstop.errors import InputError
from bumpstop.io.case import load_case

__all__ = ["verify_command"]


def verify_command(names: Sequence[str], *, folder: Path, method: str | None, json: bool) -> int:
    """Check cases of a folder against their references; return the status."""
    known = _cases(folder)
    chosen = [one_of("case", name, known) for name in names] or known
    results = [
        solve_case(load_case(folder / name / "case.toml"), method, progress_display)
        for name in chosen
    ]
    passed = all(result.passed for result in results)
    if json:
        print_json({"cases": [case_record(result) for result in results], "passed": passed})
    else:
        print_table(_table(results))
        print_line("passed" if passed else "FAILED", style="green" if passed else "bold red")
    return 0 if passed else 1


def _cases(folder: Path) -> list[str]:
    if not folder.is_dir():
        hint = "name the folder with --cases"
        raise InputError("no such folder", key="--cases", value=str(folder), hint=hint)
    names = sorted(file.parent.name for file in folder.glob("*/case.toml"))
    if not names:
        hint = "a case is a folder in it that holds a case.toml"
        raise InputError("holds no cases", key="--cases", value=str(folder), hint=hint)
    return names


def _table(results: Sequence[CaseResult]) -> Table:
    lines = [(result, variant) for result in results for variant in result.variants]
    return Table(
        headers=("case", "variant", "method", "of tolerance", "checks"),
        rows=[_row(result, variant) for result, variant in lines],
        good=[variant.passed for _, variant in lines],
        labels=3,
    )


def _row(result: CaseResult, variant: VariantResult) -> tuple[str, ...]:
    worst = max((check.tolerance_used for check in variant.checks), default=None)
    return (
        result.case.name,
        variant.name,
        "modes" if variant.response is None else variant.response.method,
        "" if worst is None else f"{100 * worst:.0f} %",
        verdict(variant.checks),
    )
