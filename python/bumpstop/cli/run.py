"""``bumpstop run``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from bumpstop.arguments import one_of
from bumpstop.cli.console import print_error, print_json
from bumpstop.cli.outputs import Exports, output_names, write_outputs
from bumpstop.cli.progress import progress_display
from bumpstop.cli.records import case_record
from bumpstop.cli.solve import Stepping, solve_case
from bumpstop.cli.staging import check_writable
from bumpstop.cli.summary import print_summary, print_written
from bumpstop.errors import InputError
from bumpstop.io import FORMATS
from bumpstop.io.case import Case, load_case

__all__ = ["run_command"]


def run_command(
    path: Path,
    *,
    stepping: Stepping,
    out: Path | None,
    export: str | None,
    json: bool,
    report: bool,
) -> int:
    """Simulate a case, write what was asked for and say how it compares; return the status."""
    if export is not None and out is None:
        raise InputError("needs a folder to write to", key="--export", hint="give --out, too")
    case = load_case(path)
    exports = _exports(case, export)
    names = output_names(case, exports, report=report)
    if out is not None:
        check_writable(out, names)
    result = solve_case(case, stepping, progress_display)
    record = case_record(result)
    if out is not None:
        write_outputs(result, out, exports, report=report)
    unread = _unread(record)
    if json:
        print_json(record)
    else:
        print_summary(result, record)
        if out is not None:
            print_written(out, names)
    for line in unread:
        print_error(f"{path}: {line}")
    return 0 if result.passed and not unread else 1


def _unread(record: dict[str, Any]) -> list[str]:
    """Return a line for each result of the case that could not be read, of all variants."""
    results = [told for variant in record["variants"] for told in variant["results"]]
    return list(dict.fromkeys(told["missing"] for told in results if told["missing"]))


def _exports(case: Case, asked: str | None) -> Exports:
    """Return the formats of each variant: those asked for, or those that the case says."""
    if asked is None:
        return case.exports
    formats = [one_of("--export", form, tuple(FORMATS)) for form in asked.split(",")]
    return dict.fromkeys(case.problems, formats)
