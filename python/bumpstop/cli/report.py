"""``bumpstop report``."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from bumpstop.cli.console import print_error, print_line
from bumpstop.cli.outputs import REPORT, write_comparison_alone, write_report_alone
from bumpstop.cli.progress import progress_display
from bumpstop.cli.solve import Stepping, solve_case
from bumpstop.cli.staging import check_writable
from bumpstop.errors import InputError
from bumpstop.io.case import load_case

if TYPE_CHECKING:
    from bumpstop.response import Response

__all__ = ["report_command"]

COMPARISON = "compare.html"


def report_command(paths: Sequence[Path], *, stepping: Stepping, out: Path) -> int:
    """Simulate a case and write its report, or compare several runs; return the status.

    A run is a variant of a case, which is simulated, or a response in a NetCDF file. A case alone
    gets its own report unless ``out`` names a page.
    """
    page = out if out.suffix.lower() == ".html" else None
    if len(paths) > 1 or page is not None or _is_response(paths[0]):
        place = page or out / COMPARISON
        check_writable(place.parent, [place.name])
        write_comparison_alone(_runs(paths, stepping), place)
        print_line(f"written to {place}")
        return 0
    case = load_case(paths[0])
    check_writable(out, [REPORT])
    result = solve_case(case, stepping, progress_display)
    unread = write_report_alone(result, out)
    print_line(f"written to {out / REPORT}")
    for line in unread:
        print_error(f"{paths[0]}: {line}")
    return 0 if result.passed and not unread else 1


def _runs(paths: Sequence[Path], stepping: Stepping) -> dict[str, Response]:
    """Return the runs by names that tell them apart."""
    found: dict[str, Response] = {}
    for name, response in _named(paths, stepping):
        number, unique = 2, name
        while unique in found:
            unique, number = f"{name} ({number})", number + 1
        found[unique] = response
    if len(found) < 2:
        hint = "name another case or response, or a folder for the report of one"
        raise InputError("there is one run alone to compare", key="report", hint=hint)
    return found


def _named(paths: Sequence[Path], stepping: Stepping) -> Iterator[tuple[str, Response]]:
    for path in paths:
        if _is_response(path):
            from bumpstop.io.stored import read_netcdf

            own = path.parent if path.stem == "response" else path.with_suffix("")
            yield "/".join(own.parts[-2:]), read_netcdf(path)
            continue
        case = load_case(path)
        responses = solve_case(case, stepping, progress_display).responses
        for variant, response in responses.items():
            yield (f"{case.name}/{variant}" if len(responses) > 1 else case.name), response


def _is_response(path: Path) -> bool:
    return path.suffix.lower() == ".nc"
