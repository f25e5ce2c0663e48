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
from bumpstop.study.pool import evaluated, usable_cores

if TYPE_CHECKING:
    from bumpstop.study.cluster import Cluster, Scheduler
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
    there = int(np.count_nonzero(store.read("status")))
    chunks = np.flatnonzero(store.read("status")[:: layout.chunk] == 0).tolist()
    made = failed = 0
    processes = usable_cores() if workers is None else count("workers", workers)
    processes = max(1, min(processes, len(chunks)))
    if study.follows:
        if cluster is not None:
            what = "is of no use where each run waits for the one before it"
            raise InputError(what, key="scheduler", hint="leave it out")
        crew, processes = chained(study, store.read, chunks), 1
    elif cluster is None:
        crew = evaluated(study.recipe, chunks, study.task, processes)
    else:
        crew = cluster.evaluated(study.recipe, study.files, chunks, study.task)
    with closing(crew):
        for task, kept in crew:
            with interrupts_later():
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
        workers=processes if cluster is None else cluster.threads,
    )


@contextmanager
def hired(scheduler: Scheduler | None) -> Iterator[Cluster | None]:
    """Connect to a scheduler for a while; None where there is none.

    Parameters
    ----------
    scheduler
        Its address, its scheduler file, or a cluster or client of ``distributed``.

    Raises
    ------
    InputError
        If ``distributed`` is not installed, or the scheduler does not answer.
    """
    if scheduler is None:
        yield None
        return
    if find_spec("distributed") is None:
        hint = "pip install 'bumpstop[cluster]', or leave it out to use this machine"
        what = "needs the package distributed, which is not installed"
        raise InputError(what, key="scheduler", hint=hint)
    from bumpstop.study.cluster import Cluster

    with closing(Cluster(scheduler)) as cluster:
        yield cluster
