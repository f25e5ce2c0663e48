"""``bumpstop run``."""

from __future__ import annotations

from pathlib import Path

from bumpstop.cli.console import print_json
from bumpstop.cli.outputs import output_names, write_outputs
from bumpstop.cli.progress import progress_display
from bumpstop.cli.records import case_record
from bumpstop.cli.solve import Stepping, solve_case
from bumpstop.cli.staging import check_writable
from bumpstop.cli.summary import print_summary, print_written
from bumpstop.io.case import load_case

__all__ = ["run_command"]


def run_command(
    path: Path, *, stepping: Stepping, out: Path | None, json: bool, report: bool
) -> int:
    """Simulate a case, write what was asked for and say how it compares; return the status."""
    case = load_case(path)
    if out is not None:
        check_writable(out, output_names(case, report=report))
    result = solve_case(case, stepping, progress_display)
    record = case_record(result)
    if out is not None:
        write_outputs(result, out, report=report)
    if json:
        print_json(record)
    else:
        print_summary(result, record)
        if out is not None:
            print_written(out, output_names(case, report=report))
    return 0 if result.passed else 1
