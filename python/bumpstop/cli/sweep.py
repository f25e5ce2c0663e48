"""``bumpstop sweep``."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from bumpstop.arguments import count
from bumpstop.cli.console import Table, print_error, print_json, print_line, print_table
from bumpstop.cli.progress import runs_display
from bumpstop.study.evaluation import FAILED
from bumpstop.study.execution import Summary, execute
from bumpstop.study.layout import unpacked_message
from bumpstop.study.load import read_study

if TYPE_CHECKING:
    from bumpstop.study.parameters import Level
    from bumpstop.study.store import Reader
    from bumpstop.study.study import Study

__all__ = ["sweep_command"]

NONE_GOOD = 3
TOLD_FAILURES = 5


def sweep_command(
    path: Path, *, store: Path | None, workers: int | None, resume: bool, json: bool
) -> int:
    """Make the runs of a study file, and tell what came out; return the exit status.

    It is 0 where any run could be made, since failed ones are results, too.
    """
    loaded = read_study(path)
    study, folder = loaded.study, store or loaded.store
    if workers is not None:
        count("--workers", workers)
    opened = study.opened(folder, resume=resume)
    try:
        with runs_display(loaded.title) as tell:
            summary = execute(study, opened, workers or loaded.workers, tell)
    except KeyboardInterrupt:
        there = np.count_nonzero(opened.read("status"))
        print_error(f"interrupted: {there} of {study.runs.count} runs are kept; go on by --resume")
        raise
    found = _Found(study, opened.read)
    if json:
        print_json(_record(loaded.title, summary, folder, found))
    else:
        _print(loaded.title, summary, folder, found)
    return NONE_GOOD if summary.failed == summary.runs else 0


class _Extremes(NamedTuple):
    """What one output was over the runs."""

    smallest: float
    mean: float
    largest: float
    smallest_in: int
    largest_in: int


class _Found:
    """The results, for those who want a word of them."""

    def __init__(self, study: Study, read: Reader) -> None:
        self._study = study
        self._read = read

    @property
    def units(self) -> dict[str, str]:
        """The unit of each output."""
        return {name: each.attributes["units"] for name, each in self._study.outputs.items()}

    @property
    def failed(self) -> list[int]:
        """The first runs that failed."""
        runs = np.flatnonzero(self._read("status") == FAILED)[:TOLD_FAILURES]
        numbers: list[int] = runs.tolist()
        return numbers

    def message(self, run: int) -> str:
        """Return why a run failed."""
        return unpacked_message(self._read("message", slice(run, run + 1))[0])

    def parameters(self, run: int) -> dict[str, Level]:
        """Return the values that a run had."""
        row = self._study.runs.row(run)
        return {name: row[name] for name in self._study.parameters}

    def extremes(self, name: str) -> _Extremes | None:
        """Return the smallest and largest value of an output; None where it has none."""
        values = self._read(name).reshape(self._study.runs.count, -1)
        if np.isnan(values).all():
            return None
        smallest, largest = int(np.nanargmin(values)), int(np.nanargmax(values))
        return _Extremes(
            smallest=float(values.flat[smallest]),
            mean=float(np.nanmean(values)),
            largest=float(values.flat[largest]),
            smallest_in=smallest // values.shape[1],
            largest_in=largest // values.shape[1],
        )


def _print(title: str, summary: Summary, folder: Path, found: _Found) -> None:
    print_line(title, style="bold")
    print_line(_told(summary))
    print_line()
    rows = [_row(name, units, found) for name, units in found.units.items()]
    print_table(
        Table(
            headers=("output", "unit", "smallest", "mean", "largest", "the largest with"),
            rows=rows,
            labels=2,
        )
    )
    if summary.failed:
        print_line()
        print_line(f"{summary.failed} failed, such as", style="bold red")
        for run in found.failed:
            print_line(f"  {_listed(found.parameters(run))}: {found.message(run)}")
    print_line()
    print_line(f"written to {folder}")


def _told(summary: Summary) -> str:
    before = summary.runs - summary.made
    there = f", {before:,} of them before" if before else ""
    rate = f", {summary.made / summary.seconds:.4g} a second" if summary.made else ""
    workers = f"{summary.workers} process{'es' if summary.workers > 1 else ''}"
    return f"{summary.runs:,} runs{there}: {summary.seconds:.1f} s by {workers}{rate}"


def _row(name: str, units: str, found: _Found) -> tuple[str, ...]:
    extremes = found.extremes(name)
    if extremes is None:
        return (name, units, "-", "-", "-", "")
    numbers = (extremes.smallest, extremes.mean, extremes.largest)
    with_values = _listed(found.parameters(extremes.largest_in))
    return (name, units, *(f"{number:.6g}" for number in numbers), with_values)


def _listed(parameters: Mapping[str, Level]) -> str:
    told = {
        name: f"{value:.6g}" if isinstance(value, float) else str(value)
        for name, value in parameters.items()
    }
    return ", ".join(f"{name} = {value}" for name, value in told.items())


def _record(title: str, summary: Summary, folder: Path, found: _Found) -> dict[str, Any]:
    return {
        "title": title,
        "store": str(folder),
        "runs": summary.runs,
        "made": summary.made,
        "failed": summary.failed,
        "seconds": summary.seconds,
        "workers": summary.workers,
        "outputs": {
            name: {"units": units, **_extremes_record(found, name)}
            for name, units in found.units.items()
        },
        "failures": [
            {"run": run, "parameters": found.parameters(run), "message": found.message(run)}
            for run in found.failed
        ],
    }


def _extremes_record(found: _Found, name: str) -> dict[str, Any]:
    extremes = found.extremes(name)
    if extremes is None:
        return {"smallest": None, "mean": None, "largest": None}
    return {
        "smallest": extremes.smallest,
        "mean": extremes.mean,
        "largest": extremes.largest,
        "smallest_with": found.parameters(extremes.smallest_in),
        "largest_with": found.parameters(extremes.largest_in),
    }
