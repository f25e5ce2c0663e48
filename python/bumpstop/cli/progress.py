"""A progress bar for runs that take longer than a second."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from time import monotonic

__all__ = ["progress_display"]

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
