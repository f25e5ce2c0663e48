"""``bumpstop verify``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from bumpstop.arguments import one_of
from bumpstop.cli.console import Table, print_error, print_json, print_line, print_table
from bumpstop.cli.progress import progress_display
from bumpstop.cli.records import case_record
from bumpstop.cli.solve import CaseResult, Stepping, VariantResult, solve_case
from bumpstop.cli.summary import verdict
from bumpstop.errors import BumpstopError, InputError
from bumpstop.io.case import load_case

__all__ = ["verify_command"]


def verify_command(names: Sequence[str], *, folder: Path, stepping: Stepping, json: bool) -> int:
    """Check cases of a folder against their references; return the status.

    A case that cannot be run does not keep the others from being checked.
    """
    known = _cases(folder)
    chosen = [one_of("case", name, known) for name in names] or known
    stepping.check()
    results = {name: _result(folder / name / "case.toml", stepping) for name in chosen}
    status = max(map(_status, results.values()))
    for result in results.values():
        if isinstance(result, BumpstopError):
            print_error(str(result))
    if json:
        records = [_record(name, result) for name, result in results.items()]
        print_json({"cases": records, "passed": status == 0})
    else:
        print_table(_table(results))
        print_line("FAILED" if status else "passed", style="bold red" if status else "green")
    return status


def _result(path: Path, stepping: Stepping) -> CaseResult | BumpstopError:
    """Return what came out of a case, or why nothing did."""
    try:
        return solve_case(load_case(path), stepping, progress_display)
    except BumpstopError as error:
        return error


def _status(result: CaseResult | BumpstopError) -> int:
    if isinstance(result, BumpstopError):
        return result.exit_status
    return 0 if result.passed else 1


def _cases(folder: Path) -> list[str]:
    if not folder.is_dir():
        hint = "name the folder with --cases"
        raise InputError("no such folder", key="--cases", value=str(folder), hint=hint)
    names = sorted(file.parent.name for file in folder.glob("*/case.toml"))
    if not names:
        hint = "a case is a folder in it that holds a case.toml"
        raise InputError("holds no cases", key="--cases", value=str(folder), hint=hint)
    return names


def _record(name: str, result: CaseResult | BumpstopError) -> dict[str, Any]:
    if isinstance(result, BumpstopError):
        return {"case": name, "variants": [], "passed": False, "error": str(result)}
    return case_record(result)


def _table(results: dict[str, CaseResult | BumpstopError]) -> Table:
    rows = [row for name, result in results.items() for row in _rows(name, result)]
    return Table(
        headers=("case", "variant", "method", "of tolerance", "checks"),
        rows=[row for row, _ in rows],
        good=[good for _, good in rows],
        labels=3,
    )


def _rows(name: str, result: CaseResult | BumpstopError) -> Iterator[tuple[tuple[str, ...], bool]]:
    """Yield the lines of a case, and whether each is good."""
    if isinstance(result, BumpstopError):
        yield (name, "", "", "", "could NOT be run"), False
        return
    for variant in result.variants:
        yield _row(name, variant), variant.passed


def _row(case: str, variant: VariantResult) -> tuple[str, ...]:
    worst = max((check.tolerance_used for check in variant.checks), default=None)
    return (
        case,
        variant.name,
        "modes" if variant.response is None else variant.response.method,
        "" if worst is None else f"{100 * worst:.0f} %",
        verdict(variant.checks),
    )
