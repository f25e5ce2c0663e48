"""``bumpstop sweep STUDY.toml --open RUN``."""

from __future__ import annotations

from pathlib import Path

from bumpstop.cli.run import run_command
from bumpstop.cli.solve import Stepping
from bumpstop.cli.staging import check_writable
from bumpstop.io.case.keys import keyed
from bumpstop.study.load import read_study
from bumpstop.study.single import checked_start, write_case

__all__ = ["open_command"]

CASE = "case.toml"


def open_command(path: Path, run: int, *, store: Path | None, json: bool) -> int:
    """Make one run of a study as a case of its own, and report on it; return the status.

    The case file stands in a folder beside the store, with the response and the report.
    """
    loaded = read_study(path)
    beside = store or loaded.store
    folder = beside.with_name(f"{beside.stem}-run-{run}")
    with keyed(renamed={"run": "--open", "--out": "--open"}):
        checked_start(loaded.study, run, beside)
        check_writable(folder, [CASE])
    folder.mkdir(parents=True, exist_ok=True)
    case = write_case(loaded.study, run, folder / CASE, store=beside)
    stepping = Stepping(None, None, None)
    return run_command(case, stepping=stepping, out=folder, export=None, json=json, report=True)
