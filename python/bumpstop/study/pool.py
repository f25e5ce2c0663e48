"""Runs made by several processes at a time.

Each worker has a thread of ours that feeds it and waits for it; the results come in the order in
which they are ready. A worker that dies takes no run with it: its runs are made again, one by
one, and only one that kills a second worker has failed.
"""

from __future__ import annotations

import os
import sys
from collections import deque
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import pairwise
from queue import Empty, Queue, SimpleQueue
from subprocess import PIPE, Popen
from threading import Lock, Thread
from typing import Any, BinaryIO, NamedTuple, cast

from bumpstop.study.evaluation import Evaluator, Kept, Recipe
from bumpstop.study.frames import receive, send
from bumpstop.study.parameters import Level

__all__ = ["DIED", "Crew", "Done", "Task", "Worker", "evaluated", "usable_cores"]

DIED = "the process that made this run died: it was killed, or found no memory"


class Task(NamedTuple):
    """Runs that are made together."""

    chunk: int
    """Which chunk of the study they are."""
    columns: Mapping[str, Sequence[Level]]
    """Values of each parameter, one a run."""


class Done(NamedTuple):
    """A task, and what is kept of its runs."""

    task: Task
    kept: Kept


def usable_cores() -> int:
    """Return how many cores this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def evaluated(
    recipe: Recipe, chunks: Sequence[int], task_of: Callable[[int], Task], workers: int
) -> Generator[Done]:
    """Yield what is kept of each chunk, in the order in which they are done.

    Parameters
    ----------
    recipe
        How runs are made.
    chunks
        Numbers of the chunks to be made.
    task_of
        Tells the runs of a chunk, when its turn has come.
    workers
        How many processes, or threads of this one where the core makes the runs by itself;
        with one, the runs are made in this process.
    """
    evaluator = Evaluator(recipe) if chunks else None
    if evaluator is None:
        return
    if workers == 1 or len(chunks) < 2:
        for task in map(task_of, chunks):
            yield Done(task, evaluator.kept(task.columns))
        return
    if evaluator.runs_in_core(task_of(chunks[0]).columns):
        yield from _by_threads(evaluator, chunks, task_of, workers)
        return
    todo: SimpleQueue[int] = SimpleQueue()
    for chunk in chunks:
        todo.put(chunk)
    # Bounded, so that results do not pile up where the disk is slower than the workers.
    done: Queue[Done | Exception] = Queue(maxsize=2 * workers)
    feeders = [_Feeder(recipe, todo, task_of, done) for _ in range(workers)]
    try:
        for _ in chunks:
            found = done.get()
            if isinstance(found, Exception):
                raise found
            yield found
    finally:
        for feeder in feeders:
            feeder.end()
        _drain(done, feeders)


def _by_threads(
    evaluator: Evaluator, chunks: Sequence[int], task_of: Callable[[int], Task], workers: int
) -> Iterator[Done]:
    """Yield what is kept of each chunk, made by threads; the core works without the GIL."""
    from concurrent.futures import Future, ThreadPoolExecutor

    def made(chunk: int) -> Done:
        task = task_of(chunk)
        return Done(task, evaluator.kept(task.columns))

    pool = ThreadPoolExecutor(workers)
    waiting: deque[Future[Done]] = deque()
    try:
        for chunk in chunks:
            waiting.append(pool.submit(made, chunk))
            # Bounded, so that results do not pile up where the disk is slower.
            if len(waiting) > 2 * workers:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
    finally:
        pool.shutdown(cancel_futures=True)


def _drain(done: Queue[Done | Exception], feeders: Sequence[_Feeder]) -> None:
    """Wait for all feeders, some of which may wait for room for a result that nobody wants."""
    while any(feeder.thread.is_alive() for feeder in feeders):
        with suppress(Empty):
            done.get(timeout=0.01)


class _EndedError(Exception):
    """Nobody wants more results."""


class _Feeder:
    """Takes tasks, has a process make them, and hands over what comes back."""

    def __init__(
        self,
        recipe: Recipe,
        todo: SimpleQueue[int],
        task_of: Callable[[int], Task],
        done: Queue[Done | Exception],
    ) -> None:
        self._todo = todo
        self._task_of = task_of
        self._done = done
        self._hand = _Hand(recipe)
        self.end = self._hand.end
        self.thread = Thread(target=self._work, daemon=True)
        self.thread.start()

    def _work(self) -> None:
        """Work until nothing is left to do."""
        try:
            while True:
                task = self._task_of(self._todo.get_nowait())
                self._done.put(Done(task, self._hand.kept(task.columns)))
        except (Empty, _EndedError):
            self.end()
        except Exception as error:  # for the main thread to raise
            self.end()
            self._done.put(error)


class Crew:
    """Threads or processes that make runs side by side, whenever some are wanted.

    Parameters
    ----------
    recipe
        How runs are made.
    workers
        How many processes, or threads of this one where the core makes the runs by itself;
        with one, the runs are made in this process.
    """

    def __init__(self, recipe: Recipe, workers: int) -> None:
        from concurrent.futures import ThreadPoolExecutor

        self._recipe = recipe
        self._workers = workers
        self._evaluator = Evaluator(recipe)
        self._hands: list[_Hand] = []
        self._threads = ThreadPoolExecutor(workers)

    def kept(self, columns: Mapping[str, Sequence[Level]]) -> Kept:
        """Return what is kept of the runs with these values of the parameters."""
        number = len(next(iter(columns.values())))
        ends = [number * part // self._workers for part in range(self._workers + 1)]
        parts = [
            {name: column[start:end] for name, column in columns.items()}
            for start, end in pairwise(ends)
            if end > start
        ]
        if self._workers == 1 or self._evaluator.runs_in_core(columns):
            return Kept.joined(list(self._threads.map(self._evaluator.kept, parts)))
        while len(self._hands) < len(parts):
            self._hands.append(_Hand(self._recipe))
        made = self._threads.map(lambda hand, part: hand.kept(part), self._hands, parts)
        return Kept.joined(list(made))

    def close(self) -> None:
        """End threads and processes, at once and for good."""
        for hand in self._hands:
            hand.end()
        self._threads.shutdown(cancel_futures=True)


class _Hand:
    """A process that makes runs, and another one where it dies of them."""

    def __init__(self, recipe: Recipe) -> None:
        self._recipe = recipe
        self._ended = False
        self._worker: Worker | None = None
        self._lock = Lock()  # of the two above

    def kept(self, columns: Mapping[str, Sequence[Level]]) -> Kept:
        """Return what is kept of runs; those that a process dies of are made one by one."""
        found = self._answer(columns)
        return found if found is not None else self._one_by_one(columns)

    def end(self) -> None:
        """End the process, at once and for good."""
        with self._lock:
            self._ended = True
            if self._worker is not None:
                self._worker.end()

    def _one_by_one(self, columns: Mapping[str, Sequence[Level]]) -> Kept:
        """Make runs that have killed a process, each by itself."""
        number = len(next(iter(columns.values())))
        kept = Kept.failed(self._recipe.outputs, [DIED] * number)
        for run in range(number):
            single = self._answer({name: [column[run]] for name, column in columns.items()})
            if single is not None:
                kept.put(run, single)
        return kept

    def _answer(self, columns: Mapping[str, Sequence[Level]]) -> Kept | None:
        """Return what a process makes of runs; None if it died of them."""
        with self._lock:
            if self._ended:
                raise _EndedError
            if self._worker is None:
                self._worker = Worker(self._recipe)
            worker = self._worker
        kept = worker.answer(columns)
        if kept is None:
            with self._lock:
                worker.end()
                self._worker = None
        return kept


class Worker:
    """A process that makes runs: `bumpstop.study.worker`."""

    def __init__(self, recipe: Recipe) -> None:
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
        # In a group of its own, so that Ctrl-C comes to us alone.
        group = {"process_group": 0} if os.name == "posix" else {}
        command = [sys.executable, "-m", "bumpstop.study.worker"]
        self.process = Popen(command, stdin=PIPE, stdout=PIPE, env=environment, **cast(Any, group))
        with suppress(OSError):  # it died at once: the first answer tells
            send(cast(BinaryIO, self.process.stdin), recipe)

    def answer(self, columns: Mapping[str, Sequence[Level]]) -> Kept | None:
        """Return what is kept of runs; None if the process died of them."""
        try:
            send(cast(BinaryIO, self.process.stdin), columns)
            kept: Kept = receive(cast(BinaryIO, self.process.stdout))
        except (EOFError, OSError, ValueError):  # ValueError: `end` has closed the stream
            return None
        return kept

    def end(self) -> None:
        """End the process."""
        self.process.kill()
        self.process.wait()
        for stream in (self.process.stdin, self.process.stdout):
            with suppress(OSError):  # of what could not be written any more
                cast(BinaryIO, stream).close()
