"""Runs that follow one another: each starts in the state in which the one before it ended."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.study.evaluation import GOOD, Evaluator, Kept, told_failure
from bumpstop.study.layout import STATE
from bumpstop.study.pool import Done

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.study.store import Reader
    from bumpstop.study.study import Study

__all__ = ["chained"]


def chained(study: Study, read: Reader, chunks: Sequence[int]) -> Generator[Done]:
    """Yield what is kept of each chunk, with the state at the end of each run.

    The way up and the way down start as the case does. A run that fails is left out of its way:
    the next one starts where the last good one ended.

    Parameters
    ----------
    study
        The study.
    read
        Reads what has been kept; the chunk before must be there when the next one is asked for.
    chunks
        Those that have not been made: the last ones.
    """
    evaluator = Evaluator(study.recipe)
    turn = study.layout.count // 2
    for chunk in chunks:
        part = study.layout.part(chunk)
        task = study.task(chunk)
        kept = Kept.failed(study.outputs, [""] * (part.stop - part.start))
        state = _before(read, part.start)
        ends = np.empty((len(kept.status), *state.shape))
        for number in range(len(kept.status)):
            if (part.start + number) % turn == 0:
                state = np.full_like(state, np.nan)
            changes = {name: column[number] for name, column in task.columns.items()}
            try:
                values, state = evaluator.followed(changes, state)
            except Exception as error:  # also a mistake of ours: the other runs go on
                kept.messages[number] = told_failure(error)
            else:
                for name, value in values.items():
                    kept.values[name][number] = value
                kept.status[number] = GOOD
            ends[number] = state
        for order, name in enumerate(STATE):
            kept.values[name] = ends[:, order]
        yield Done(task, kept)


def _before(read: Reader, run: int) -> FloatArray:
    """Return the state, (order, mode), that a run starts from; NaN where none is known."""
    last = slice(max(run - 1, 0), max(run, 1))
    state: FloatArray = np.stack([read(name, last)[0] for name in STATE])
    return state
