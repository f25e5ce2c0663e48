"""``bumpstop sweep``."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from bumpstop.arguments import count
from bumpstop.cli.console import Table, print_error, print_json, print_line, print_table
from bumpstop.cli.progress import runs_display
from bumpstop.cli.sensitivity import Sensitivities, sensitivities, sensitivity_table
from bumpstop.study.basins import SECTION, Attractor, classified
from bumpstop.study.evaluation import FAILED
from bumpstop.study.execution import Summary, execute, hired
from bumpstop.study.layout import unpacked_message
from bumpstop.study.load import LoadedStudy, read_study

if TYPE_CHECKING:
    from bumpstop.study.parameters import Level
    from bumpstop.study.store import Reader, Store
    from bumpstop.study.study import Study

__all__ = ["sweep_command"]

NONE_GOOD = 3
TOLD_FAILURES = 5
MOST_REPORTED = 1_000_000
"""Runs whose results are read into memory at once, to be drawn."""


def sweep_command(
    path: Path,
    *,
    store: Path | None,
    workers: int | None,
    scheduler: str | None,
    resume: bool,
    json: bool,
    report: bool,
) -> int:
    """Make the runs of a study file, and tell what came out; return the exit status.

    It is 0 where any run could be made, since failed ones are results, too.
    """
    loaded = read_study(path)
    study, folder = loaded.study, store or loaded.store
    if workers is not None:
        count("--workers", workers)
    with hired(study, scheduler) as cluster:
        opened = study.opened(folder, resume=resume)
        try:
            with runs_display(loaded.title) as tell:
                summary = execute(study, opened, workers or loaded.workers, tell, cluster)
        except KeyboardInterrupt:
            there = np.count_nonzero(opened.read("status"))
            print_error(
                f"interrupted: {there} of {study.runs.count} runs are kept; go on by --resume"
            )
            raise
    found = _Found(study, opened.read)
    if not json:  # before the page, which a full disk may have no room for
        _print(loaded.title, summary, folder, found)
    page = _page(loaded, opened, folder, _opened_by(path, store)) if report else None
    if json:
        print_json(_record(loaded.title, summary, folder, found) | {"report": page and str(page)})
    elif page is not None:
        print_line(f"report in {page}")
    return NONE_GOOD if summary.failed == summary.runs else 0


def _page(loaded: LoadedStudy, store: Store, folder: Path, opened_by: str) -> Path | None:
    """Write the report beside the store; None where there are too many runs to draw."""
    study = loaded.study
    if study.runs.count > MOST_REPORTED:
        return None
    from bumpstop.report.html import write_study

    page = folder.with_name(f"{folder.stem}.html")
    results = study.labelled(store)
    write_study(study, results, page, title=loaded.title, opened_by=opened_by)
    return page


def _opened_by(path: Path, store: Path | None) -> str:
    """Return the command that opens a run, up to its number."""
    beside = [] if store is None else ["--store", str(store)]
    return shlex.join(["bumpstop", "sweep", str(path), *beside, "--open"])


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
        outputs = self._study.outputs.items()
        return {name: each.attributes["units"] for name, each in outputs if name not in SECTION}

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

    @cached_property
    def sensitivities(self) -> Sensitivities:
        """What each parameter does to each output, where the runs were made to tell."""
        return sensitivities(self._study, self._read)

    @cached_property
    def attractors(self) -> tuple[Attractor, ...]:
        """The attractors that runs end on, where they are asked for."""
        basins = self._study.basins
        return () if basins is None else classified(basins, *map(self._read, SECTION)).attractors

    @property
    def worst(self) -> str | None:
        """What a search has found in a line; None where there was none, or it found nothing."""
        if not self._study.searches:
            return None
        sought = self._study.sought
        extremes = self.extremes(sought)
        if extremes is None:
            return f"no run has {sought}"
        unit = "" if self.units[sought] == "1" else f" {self.units[sought]}"
        return f"worst case: {sought} = {extremes.largest:.9g}{unit} in run {extremes.largest_in}"

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
    _print_outputs(found)
    if found.sensitivities:
        print_line()
        print_table(sensitivity_table(found.sensitivities))
    _print_attractors(found)
    if found.worst is not None:
        print_line()
        print_line(found.worst)
    if summary.failed:
        print_line()
        print_line(f"{summary.failed} failed, such as", style="bold red")
        for run in found.failed:
            print_line(f"  {_listed(found.parameters(run))}: {found.message(run)}")
    print_line()
    print_line(f"written to {folder}")


def _print_outputs(found: _Found) -> None:
    rows = [_row(name, units, found) for name, units in found.units.items()]
    if rows:
        headers = ("output", "unit", "smallest", "mean", "largest", "the largest with")
        print_table(Table(headers=headers, rows=rows, labels=2))


def _print_attractors(found: _Found) -> None:
    if not found.attractors:
        return
    rows = [
        (
            str(number),
            f"{each.runs:,}",
            str(each.periods),
            f"{each.displacement[0]:.6g}",
            f"{each.velocity[0]:.6g}",
        )
        for number, each in enumerate(found.attractors, start=1)
    ]
    headers = ("attractor", "runs", "periods", "displacement (m)", "velocity (m/s)")
    print_table(Table(headers=headers, rows=rows, labels=1))


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
        **({"sensitivities": found.sensitivities} if found.sensitivities else {}),
        "attractors": [
            {
                "runs": each.runs,
                "periods": each.periods,
                "displacement": each.displacement.tolist(),
                "velocity": each.velocity.tolist(),
            }
            for each in found.attractors
        ],
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
