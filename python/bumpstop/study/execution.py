"""A study is run: chunk by chunk, into memory or a store."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from importlib.util import find_spec
from time import monotonic
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bumpstop.arguments import count
from bumpstop.errors import InputError
from bumpstop.interrupts import interrupts_later
from bumpstop.study.chain import chained
from bumpstop.study.evaluation import FAILED, GOOD
from bumpstop.study.pool import Done, evaluated, usable_cores
from bumpstop.study.search import search

if TYPE_CHECKING:
    from bumpstop.study.cluster import Cluster, Scheduler
    from bumpstop.study.layout import Layout
    from bumpstop.study.store import Store
    from bumpstop.study.study import Study

__all__ = ["Progress", "Summary", "execute", "hired"]


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
    """Processes or threads that made them."""


def execute(
    study: Study,
    store: Store,
    workers: int | None = None,
    progress: Callable[[Progress], None] | None = None,
    cluster: Cluster | None = None,
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
    cluster
        Whose workers make the runs; processes of this machine where left out.

    Raises
    ------
    InputError
        If results cannot be kept; those before are.
    ComputationError
        If the scheduler goes away; what was made before is kept.
    """
    started = monotonic()
    layout = study.layout
    chunks = np.flatnonzero(store.read("status")[:: layout.chunk] == 0).tolist()
    processes = usable_cores() if workers is None else count("workers", workers)
    keeper = _Keeper(layout, store, progress)
    if study.searches:
        processes = min(processes, layout.chunk)
        search(study, store.read, keeper.keep, processes)
    else:
        processes = 1 if study.follows else max(1, min(processes, len(chunks)))
        if study.follows:
            crew = chained(study, store.read, chunks)
        elif cluster is None:
            crew = evaluated(study.recipe, chunks, study.task, processes)
        else:
            crew = cluster.evaluated(study.recipe, study.files, chunks, study.task)
        with closing(crew):
            for done in crew:
                keeper.keep(done)
    status = store.read("status")
    assert np.all((status == GOOD) | (status == FAILED))
    return Summary(
        runs=layout.count,
        made=keeper.made,
        failed=int(np.count_nonzero(status == FAILED)),
        seconds=monotonic() - started,
        workers=processes if cluster is None else cluster.threads,
    )


class _Keeper:
    """Writes what comes, and tells how far the study is."""

    def __init__(
        self, layout: Layout, store: Store, progress: Callable[[Progress], None] | None
    ) -> None:
        self._layout = layout
        self._store = store
        self._progress = progress
        self._there = int(np.count_nonzero(store.read("status")))
        self.made = 0
        self._failed = 0

    def keep(self, done: Done) -> None:
        """Write a chunk."""
        task, kept = done
        with interrupts_later():
            self._store.write(task.chunk, self._layout.columns(task.columns), kept)
        self.made += len(kept.status)
        self._failed += int(np.count_nonzero(kept.status == FAILED))
        if self._progress is not None:
            there = self._there + self.made
            self._progress(Progress(there, self._layout.count, self.made, self._failed))


@contextmanager
def hired(study: Study, scheduler: Scheduler | None) -> Iterator[Cluster | None]:
    """Connect to a scheduler for a while; None where there is none.

    Parameters
    ----------
    study
        What it is for.
    scheduler
        Its address, its scheduler file, or a cluster or client of ``distributed``.

    Raises
    ------
    InputError
        If the study has no use for it, ``distributed`` is not installed, or the scheduler does
        not answer.
    """
    if scheduler is None:
        yield None
        return
    if study.follows or study.searches:
        what = "is of no use where runs wait for those before them"
        raise InputError(what, key="scheduler", hint="leave it out")
    if find_spec("distributed") is None:
        hint = "pip install 'bumpstop[cluster]', or leave it out to use this machine"
        what = "needs the package distributed, which is not installed"
        raise InputError(what, key="scheduler", hint=hint)
    from bumpstop.study.cluster import Cluster

    with closing(Cluster(scheduler)) as cluster:
        yield cluster
