"""Runs made by the workers of a dask scheduler, on this machine or on a cluster.

A recipe goes to each worker once, also to those that join later or are started again: as a plugin,
which the scheduler keeps, and not as scattered data, which die with the worker that holds
them. Then chunks go out, a few for each thread at a time, and their results come back here to
be written: whatever a cluster makes twice, because a worker was lost, is written once.

dask blames every task that was at a worker when it died. So a chunk that it gives up is suspect, no
more: it is kept aside until nothing else is out, and its runs are then made one at a time. Each
is alone on the cluster, and only one that kills workers by itself has failed.
"""

from __future__ import annotations

import os
from asyncio import CancelledError
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError as FutureCancelledError
from contextlib import contextmanager, suppress
from hashlib import sha256
from pathlib import Path
from threading import Lock
from time import monotonic
from typing import Any, TypeAlias, cast
from uuid import uuid4

from distributed import Client, Future, KilledWorker, WorkerPlugin, as_completed, get_worker

from bumpstop import __version__
from bumpstop.errors import ComputationError, InputError
from bumpstop.study.evaluation import Evaluator, Kept, Recipe
from bumpstop.study.parameters import Level
from bumpstop.study.pool import DIED, Done, Task

__all__ = ["Cluster", "Scheduler"]

Scheduler: TypeAlias = "str | os.PathLike[str] | Any"
"""An address, the path of a scheduler file, or a cluster or client of ``distributed``."""

PATIENCE = 15.0
"""Seconds to wait for a scheduler's answer."""
FAREWELL = 2.0
"""Seconds to wait for what a scheduler says to our leaving: it may be gone."""
AHEAD = 3
"""Chunks that are at a thread or on their way to it: none waits for work, and few are lost."""
LEAST = 8
"""Chunks that are out before any worker has come."""
_LOOK = 1.0
"""Seconds between two looks at how many workers there are."""

Columns = Mapping[str, Sequence[Level]]


class _Maker(WorkerPlugin):
    """What each worker of a cluster has of a study; a plugin of ``distributed``.

    Parameters
    ----------
    name
        What tasks ask for it by.
    recipe
        How runs are made.
    files
        Content of the files that the case names, each as its SHA-256.
    version
        Which bumpstop asks.
    """

    def __init__(self, name: str, recipe: Recipe, files: Mapping[str, str], version: str) -> None:
        self.name = name
        self._recipe = recipe
        self._files = files
        self._version = version

    def setup(self, worker: object) -> None:  # noqa: ARG002  # as distributed calls it
        """Begin; what is wrong is told by the first task, which somebody waits for."""
        self._lock = Lock()
        self._evaluator: Evaluator | None = None

    def kept(self, columns: Columns) -> Kept:
        """Return what is kept of runs."""
        with self._lock:
            if self._evaluator is None:
                self._check()
                self._evaluator = Evaluator(self._recipe)
        return self._evaluator.kept(columns)

    def _check(self) -> None:
        """Raise where this worker would make other runs than those that are asked for."""
        if __version__ != self._version:
            what = f"a worker has bumpstop {__version__}, and this is {self._version}"
            raise InputError(what, key="scheduler", hint="install the same everywhere")
        for name, digest in self._files.items():
            path = self._recipe.folder / name
            if not path.is_file() or sha256(path.read_bytes()).hexdigest() != digest:
                what = "a worker does not see this file as it is here"
                hint = "keep the case where all machines see it, by the same path"
                raise InputError(what, file=str(path), key="scheduler", hint=hint)


def _made(name: str, columns: Columns) -> Kept:
    """Make runs, on a worker."""
    return cast(_Maker, get_worker().plugins[name]).kept(columns)


class Cluster:
    """A dask scheduler with its workers.

    Parameters
    ----------
    scheduler
        Its address, its scheduler file, or a cluster or client of ``distributed``.

    Raises
    ------
    InputError
        If the scheduler does not answer.
    """

    def __init__(self, scheduler: Scheduler) -> None:
        self._own = not isinstance(scheduler, Client)
        self._client: Client = _connected(scheduler) if self._own else cast(Client, scheduler)
        self._looked = -_LOOK
        self.threads = 0

    def close(self) -> None:
        """Leave the scheduler; a client that was given stays open."""
        if self._own:
            with suppress(Exception):  # a scheduler that is gone cannot be left
                self._client.close(timeout=FAREWELL)

    def evaluated(
        self,
        recipe: Recipe,
        files: Mapping[str, str],
        chunks: Sequence[int],
        task_of: Callable[[int], Task],
    ) -> Generator[Done]:
        """Yield what is kept of each chunk, in the order in which they are done.

        Parameters
        ----------
        recipe
            How runs are made.
        files
            Content of the files that the case names, each as its SHA-256.
        chunks
            Numbers of the chunks to be made.
        task_of
            Tells the runs of a chunk, when its turn has come.

        Raises
        ------
        ComputationError
            If the scheduler goes away.
        InputError
            If a worker would make other runs.
        """
        maker = _Maker(f"bumpstop-{uuid4().hex}", recipe, files, __version__)
        with self._told():
            self._client.register_plugin(maker, maker.name)
        try:
            yield from self._fed(maker, recipe, iter(chunks), task_of)
        finally:
            if self._client.status == "running":  # a scheduler that is gone has forgotten it
                with suppress(Exception):
                    self._client.unregister_worker_plugin(maker.name)

    def _fed(
        self,
        maker: _Maker,
        recipe: Recipe,
        chunks: Iterator[int],
        task_of: Callable[[int], Task],
    ) -> Iterator[Done]:
        """Send chunks, as many as the workers can hold, and yield what comes back."""
        out: dict[Future[Kept], Task] = {}
        suspects: list[Task] = []
        with self._told():
            back = as_completed(loop=self._client.loop)
        try:
            while True:
                with self._told():
                    self._send(maker, chunks, task_of, out, back)
                    if not out:
                        break
                    task, kept = _next(back, out)
                if kept is None:
                    suspects.append(task)
                else:
                    yield Done(task, kept)
            for task in suspects:
                with self._told():
                    kept = self._one_by_one(maker, recipe, task)
                yield Done(task, kept)
        finally:
            for future in out:
                with suppress(Exception):
                    future.cancel(reason="nobody waits for it")

    def _send(
        self,
        maker: _Maker,
        chunks: Iterator[int],
        task_of: Callable[[int], Task],
        out: dict[Future[Kept], Task],
        back: as_completed,
    ) -> None:
        """Send chunks until there are enough on their way."""
        enough = self._enough()
        while len(out) < enough:
            chunk = next(chunks, None)
            if chunk is None:
                return
            task = task_of(chunk)
            future = self._submitted(maker, task.columns)
            out[future] = task
            back.add(future)

    def _enough(self) -> int:
        """Return how many chunks to have out; workers come and go."""
        if monotonic() - self._looked >= _LOOK:
            self._looked = monotonic()
            workers = self._client.scheduler_info(n_workers=-1)["workers"].values()
            self.threads = sum(worker["nthreads"] for worker in workers)
        return max(LEAST, AHEAD * self.threads)

    def _submitted(self, maker: _Maker, columns: Columns) -> Future[Kept]:
        # Not pure: no other study's results are taken for these.
        return self._client.submit(_made, maker.name, dict(columns), pure=False)

    def _one_by_one(self, maker: _Maker, recipe: Recipe, task: Task) -> Kept:
        """Make the runs of a suspect chunk, each when the one before it has ended."""
        number = len(next(iter(task.columns.values())))
        kept = Kept.failed(recipe.outputs, [DIED] * number)
        for run in range(number):
            columns = {name: [column[run]] for name, column in task.columns.items()}
            single = _result(self._submitted(maker, columns))
            if single is not None:
                kept.put(run, single)
        return kept

    @contextmanager
    def _told(self) -> Iterator[None]:
        """Say in one line that a scheduler has gone."""
        try:
            yield
        except Exception as error:
            if not (isinstance(error, _GONE) or self._client.status != "running"):
                raise
            scheduler = self._client.scheduler
            where = f" {scheduler.address}" if scheduler is not None else ""
            message = f"the scheduler{where} is gone; the runs made before are kept"
            raise ComputationError(f"{message}: go on with --resume (resume=True)") from error


_GONE = (OSError, FutureCancelledError, CancelledError)
"""What is raised where a scheduler does not answer any more, or has let our tasks go."""


def _next(back: as_completed, out: dict[Future[Kept], Task]) -> tuple[Task, Kept | None]:
    """Return the next chunk that has come back; dask may then forget it."""
    future = next(back)
    return out.pop(future), _result(future)


def _result(future: Future[Kept]) -> Kept | None:
    """Return what is kept of a task; None where workers died while it was with them."""
    try:
        kept: Kept = future.result()
    except KilledWorker:
        return None
    return kept


def _connected(scheduler: Scheduler) -> Client:
    """Return a client of a scheduler that answers."""
    given: dict[str, Any] = {"address": scheduler}
    if isinstance(scheduler, str | os.PathLike):
        text = os.fspath(scheduler)
        if text.endswith(".json"):
            if not Path(text).is_file():
                raise InputError("no such scheduler file", key="scheduler", value=text)
            given = {"scheduler_file": text}
        else:
            given = {"address": text}
    try:
        return Client(**given, timeout=PATIENCE, set_as_default=False)
    except Exception as error:  # what something else at this address answers may be anything
        hint = "start 'dask scheduler', and give the address that it prints"
        raise InputError("does not answer", key="scheduler", value=scheduler, hint=hint) from error
