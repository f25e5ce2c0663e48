"""The files that commands write."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from bumpstop.cli.solve import CaseResult, frequency_checks
from bumpstop.cli.staging import all_or_nothing
from bumpstop.io import FORMATS
from bumpstop.io.case import Case

if TYPE_CHECKING:
    from bumpstop.response import Response
    from bumpstop.study.convergence import Convergence

__all__ = [
    "MODES",
    "REPORT",
    "Exports",
    "older_outputs",
    "output_names",
    "write_comparison_alone",
    "write_convergence",
    "write_modes_page",
    "write_outputs",
    "write_report_alone",
]

MODES = "modes.html"
REPORT = "report.html"
Exports: TypeAlias = Mapping[str, Sequence[str]]
"""Formats in which the response of each variant is written beside NetCDF."""


def output_names(case: Case, exports: Exports, *, report: bool) -> list[str]:
    """Return what a run of a case writes: the paths of its files within the folder."""
    names = [f"{name}/{file}" for name in case.problems for file in _response_files(name, exports)]
    return names + [REPORT] * report


def older_outputs(folder: Path, written: Sequence[str]) -> list[str]:
    """Return outputs in a folder that are not those just written: they are of another run."""
    patterns = [f"*/response{ending}" for ending in FORMATS.values()]
    found = [path for pattern in (*patterns, REPORT) for path in folder.glob(pattern)]
    names = [path.relative_to(folder).as_posix() for path in found]
    return sorted(set(names) - set(written))


def write_outputs(result: CaseResult, folder: Path, exports: Exports, *, report: bool) -> None:
    """Write ``<variant>/response.nc`` of each variant that ran, exports, and ``report.html``.

    Raises
    ------
    InputError
        If something cannot be written; then the folder stays as it was.
    """
    with all_or_nothing(folder) as staging:
        for name, response in result.responses.items():
            (staging / name).mkdir()
            first, *others = _response_files(name, exports)
            response.to_netcdf(
                staging / name / first,
                title=result.case.title,
                case=result.case.name,
                variant=name,
                results=result.case.results.get(name, ()),
            )
            for file in others:
                response.export(staging / name / file)
        if report:
            _write_report(result, staging)


def _response_files(variant: str, exports: Exports) -> list[str]:
    """Return the files of a variant's response, NetCDF first."""
    return [
        f"response{FORMATS[form]}" for form in dict.fromkeys(["netcdf", *exports.get(variant, ())])
    ]


def write_report_alone(result: CaseResult, folder: Path) -> list[str]:
    """Write ``report.html``, and return a line for each result that could not be read.

    Raises
    ------
    InputError
        If it cannot be written; then the folder stays as it was.
    """
    with all_or_nothing(folder) as staging:
        return _write_report(result, staging)


def write_comparison_alone(runs: Mapping[str, Response], page: Path) -> None:
    """Write a page that compares runs.

    Raises
    ------
    InputError
        If it cannot be written; then the folder stays as it was.
    """
    from bumpstop.report.html import write_comparison

    with all_or_nothing(page.parent) as staging:
        write_comparison(runs, staging / page.name)


def write_convergence(found: Convergence, folder: Path) -> None:
    """Write ``report.html``, with the errors that a study of convergence found.

    Raises
    ------
    InputError
        If it cannot be written; then the folder stays as it was.
    """
    from bumpstop.report.html import write_modes, write_report

    variants = found.variants.items()
    checks = {name: variant.checks for name, variant in variants}
    responses = {name: each.response for name, each in variants if each.response is not None}
    with all_or_nothing(folder) as staging:
        if responses:
            write_report(found.case, responses, checks, staging / REPORT, found)
        else:
            write_modes(found.case, checks, staging / REPORT, found)


def write_modes_page(case: Case, folder: Path) -> None:
    """Write ``modes.html``.

    Raises
    ------
    InputError
        If it cannot be written; then the folder stays as it was.
    """
    from bumpstop.report.html import write_modes

    checks = {name: frequency_checks(case, name) for name in case.bases}
    with all_or_nothing(folder) as staging:
        write_modes(case, checks, staging / MODES)


def _write_report(result: CaseResult, folder: Path) -> list[str]:
    from bumpstop.report.html import write_modes, write_report

    checks = {variant.name: variant.checks for variant in result.variants}
    if result.responses:
        return write_report(result.case, result.responses, checks, folder / REPORT)
    write_modes(result.case, checks, folder / REPORT)
    return []
