"""``bumpstop report``."""

from __future__ import annotations

from pathlib import Path

from bumpstop.cli.console import print_error, print_line
from bumpstop.cli.outputs import REPORT, write_report_alone
from bumpstop.cli.progress import progress_display
from bumpstop.cli.solve import Stepping, solve_case
from bumpstop.cli.staging import check_writable
from bumpstop.io.case import load_case

__all__ = ["report_command"]


def report_command(path: Path, *, stepping: Stepping, out: Path) -> int:
    """Simulate a case and write its report; return the status."""
    case = load_case(path)
    check_writable(out, [REPORT])
    result = solve_case(case, stepping, progress_display)
    unread = write_report_alone(result, out)
    print_line(f"written to {out / REPORT}")
    for line in unread:
        print_error(f"{path}: {line}")
    return 0 if result.passed and not unread else 1
