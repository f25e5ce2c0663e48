"""Progress bars for what takes longer than a second."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from time import monotonic
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bumpstop.study.execution import Progress

__all__ = ["progress_display", "runs_display"]

PATIENCE = 1.0
"""Seconds before a bar appears."""


@contextmanager
def progress_display(title: str) -> Iterator[Callable[[float], None] | None]:
    """Give a function to be called with the fraction done, if anybody can see it."""
    if not sys.stderr.isatty():
        yield None
        return
    with ExitStack() as display:
        yield _teller(title, display)


def _teller(title: str, display: ExitStack) -> Callable[[float], None]:
    started = monotonic()
    update: Callable[[float], None] | None = None

    def tell(fraction: float) -> None:
        nonlocal update
        if update is None and monotonic() - started > PATIENCE:
            update = _bar(title, display)
        if update is not None:
            update(fraction)

    return tell


def _bar(title: str, display: ExitStack) -> Callable[[float], None]:
    from rich.console import Console
    from rich.progress import Progress

    bar = display.enter_context(Progress(console=Console(stderr=True), transient=True))
    task = bar.add_task(title, total=1.0)
    return lambda fraction: bar.update(task, completed=fraction)


@contextmanager
def runs_display(title: str) -> Iterator[Callable[[Progress], None] | None]:
    """Give a function to be told how many runs are made, if anybody can see it.

    It shows their rate, the time left, and how many failed.
    """
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Display

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[told]}"),
        TimeRemainingColumn(),
    )
    started = monotonic()
    with Display(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(title, total=None, told="")

        def tell(progress: Progress) -> None:
            rate = progress.made / max(monotonic() - started, 1e-9)
            failed = f", {progress.failed} failed" if progress.failed else ""
            told = f"{rate:.3g} a second{failed}"
            bar.update(task, total=progress.runs, completed=progress.done, told=told)

        yield tell
