"""A study is run: chunk by chunk, into memory or a store."""

from __future__ import annotations

from collections.abc import Callable
from time import monotonic
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bumpstop.arguments import count
from bumpstop.study.evaluation import FAILED, GOOD
from bumpstop.study.pool import evaluated, usable_cores

if TYPE_CHECKING:
    from bumpstop.study.store import Store
    from bumpstop.study.study import Study

__all__ = ["Progress", "Summary", "execute"]


class Progress(NamedTuple):
    """How far a study is."""

    done: int
    """Runs that are there, failed ones among them."""
    runs: int
    """Runs of the whole study."""
    made: int
    """Runs that were made since it was started or resumed."""
    failed: int
    """Runs that failed since then."""


class Summary(NamedTuple):
    """What a study has done."""

    runs: int
    """Runs of the whole study."""
    made: int
    """Runs made now; the others were there."""
    failed: int
    """Failed ones among all."""
    seconds: float
    """Time that the runs made now took."""
    workers: int


def execute(
    study: Study,
    store: Store,
    workers: int | None = None,
    progress: Callable[[Progress], None] | None = None,
) -> Summary:
    """Make the runs of a study that a store has not.

    Parameters
    ----------
    study
        The study.
    store
        Where results are kept.
    workers
        How many processes; as many as there are cores where left out.
    progress
        Called after each chunk.

    Raises
    ------
    InputError
        If results cannot be kept; those before are.
    """
    started = monotonic()
    layout = study.layout
    there = int(np.count_nonzero(store.read("status")))
    chunks = np.flatnonzero(store.read("status")[:: layout.chunk] == 0).tolist()
    workers = usable_cores() if workers is None else count("workers", workers)
    workers = max(1, min(workers, len(chunks)))
    made = failed = 0
    for task, kept in evaluated(study.recipe, chunks, study.task, workers):
        store.write(task.chunk, layout.columns(task.columns), kept)
        made += len(kept.status)
        failed += int(np.count_nonzero(kept.status == FAILED))
        if progress is not None:
            progress(Progress(there + made, layout.count, made, failed))
    status = store.read("status")
    assert np.all((status == GOOD) | (status == FAILED))
    return Summary(
        runs=layout.count,
        made=made,
        failed=int(np.count_nonzero(status == FAILED)),
        seconds=monotonic() - started,
        workers=workers,
    )
