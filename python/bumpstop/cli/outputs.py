"""Writing results: all of them or none."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from bumpstop.cli.solve import CaseResult, frequency_checks
from bumpstop.errors import InputError
from bumpstop.files import remove_leftovers, temporary_name
from bumpstop.io.case import Case

__all__ = ["check_writable", "write_modes_page", "write_outputs", "write_report_alone"]


def check_writable(folder: Path) -> None:
    """Refuse a folder that cannot be written to, before anything is computed.

    Raises
    ------
    InputError
        If it is a file, or its nearest parent that exists is none or cannot be written to.
    """
    nearest = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    if not nearest.is_dir():
        raise _unwritable(folder, f"{nearest} is not a folder")
    if not os.access(nearest, os.W_OK | os.X_OK):
        raise _unwritable(folder, f"{nearest} is not writable")


def write_outputs(result: CaseResult, folder: Path, *, report: bool) -> None:
    """Write ``<variant>/response.nc`` of each variant that ran, and ``report.html``.

    Raises
    ------
    InputError
        If something cannot be written; then nothing is left behind.
    """
    with _all_or_nothing(folder) as staging:
        for name, response in result.responses.items():
            (staging / name).mkdir()
            response.to_netcdf(
                staging / name / "response.nc",
                title=result.case.title,
                case=result.case.name,
                variant=name,
            )
        if report:
            _write_report(result, staging)


def write_report_alone(result: CaseResult, folder: Path) -> None:
    """Write ``report.html``.

    Raises
    ------
    InputError
        If it cannot be written; then nothing is left behind.
    """
    with _all_or_nothing(folder) as staging:
        _write_report(result, staging)


def write_modes_page(case: Case, folder: Path) -> None:
    """Write ``modes.html``.

    Raises
    ------
    InputError
        If it cannot be written; then nothing is left behind.
    """
    from bumpstop.report.html import write_modes

    checks = {name: frequency_checks(case, name) for name in case.bases}
    with _all_or_nothing(folder) as staging:
        write_modes(case, checks, staging / "modes.html")


def _write_report(result: CaseResult, folder: Path) -> None:
    from bumpstop.report.html import write_modes, write_report

    checks = {variant.name: variant.checks for variant in result.variants}
    if result.responses:
        write_report(result.case, result.responses, checks, folder / "report.html")
    else:
        write_modes(result.case, checks, folder / "report.html")


@contextmanager
def _all_or_nothing(folder: Path) -> Iterator[Path]:
    """Give a temporary folder; its files move over to the wanted one once all are complete."""
    target = folder.absolute()
    missing = [parent for parent in target.parents if not parent.exists()]
    # Within a folder that exists: what is beside it may be another disk, or closed to us.
    beside, within = target, target / "results"
    staging = temporary_name(within if target.exists() else beside)
    try:
        remove_leftovers(beside)
        remove_leftovers(within)
        staging.mkdir(parents=True)
        yield staging
        _move_over(staging, target)
    except OSError as error:
        raise _unwritable(folder, error.strerror or str(error)) from error
    except InputError as error:
        raise _unwritable(folder, error.what) from error
    finally:
        shutil.rmtree(staging, ignore_errors=True)
        _remove_empty(missing)


def _remove_empty(folders: Sequence[Path]) -> None:
    """Remove folders that were made on the way and hold nothing."""
    for folder in folders:
        if folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()


def _move_over(staging: Path, target: Path) -> None:
    if not target.exists():
        staging.rename(target)
        return
    for file in [path for path in staging.rglob("*") if path.is_file()]:
        place = target / file.relative_to(staging)
        place.parent.mkdir(exist_ok=True)
        file.replace(place)


def _unwritable(folder: Path, why: str) -> InputError:
    return InputError(
        f"cannot be written to: {why}", key="--out", value=str(folder), hint="name another folder"
    )
