"""The search for the worst case: generations of runs, placed where those before were worst."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.errors import ComputationError, InputError
from bumpstop.study.evaluation import GOOD
from bumpstop.study.layout import unpacked_message
from bumpstop.study.pool import Crew, Done, Task
from bumpstop.study.sampling import CROWD

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.study.parameters import Level
    from bumpstop.study.store import Reader
    from bumpstop.study.study import Study

__all__ = ["search"]

_POOR = 1e150
"""What the search makes smallest, where there is no result."""


def search(study: Study, read: Reader, keep: Callable[[Done], None], workers: int) -> None:
    """Search for the values of parameters that make an output largest.

    Results of impacts have jumps and many local maxima, so that gradients mislead: the search
    is by differential evolution (R. Storn, K. Price, *Journal of Global Optimization* 11
    (1997) 341; `scipy.optimize.differential_evolution`). What has been kept is not made again:
    from it, the search goes the same way as before.

    Parameters
    ----------
    study
        The study; its runs get the values that the search tells.
    read
        Reads what has been kept.
    keep
        Keeps a generation, which is a chunk.
    workers
        How many threads or processes make its runs.

    Raises
    ------
    InputError
        If what has been kept is of another search.
    ComputationError
        If no run of the first generation could be made.
    """
    from scipy.optimize import differential_evolution

    with closing(Crew(study.recipe, workers)) as crew, _input_errors():
        differential_evolution(
            _Generations(study, read, keep, crew),
            [(0.0, 1.0)] * len(study.parameters),
            popsize=CROWD,
            maxiter=study.layout.chunks - 1,
            seed=study.sampling.seed,
            # Below what any spread can be: all the runs that are asked for are made.
            tol=-1.0,
            atol=-1.0,
            polish=False,
            vectorized=True,
            updating="deferred",
        )


@contextmanager
def _input_errors() -> Iterator[None]:
    """Raise an `InputError` of ours as it was; SciPy makes another error of any ValueError."""
    try:
        yield
    except RuntimeError as error:
        if isinstance(error.__cause__, InputError):
            raise error.__cause__ from None
        raise


class _Generations:
    """Makes one generation of runs after the other."""

    def __init__(
        self, study: Study, read: Reader, keep: Callable[[Done], None], crew: Crew
    ) -> None:
        self._study = study
        self._read = read
        self._keep = keep
        self._crew = crew
        self._chunk = 0

    def __call__(self, shares: FloatArray) -> FloatArray:
        """Return what is to be made smallest, (run,), at shares (parameter, run)."""
        rows = zip(self._study.varied.items(), shares, strict=True)
        columns = {name: each.quantiles(row).tolist() for (name, each), row in rows}
        part = self._study.layout.part(self._chunk)
        self._study.runs.tell(part.start, columns)
        if self._read("status", part).all():
            self._check_kept(columns, part)
        else:
            self._keep(Done(Task(self._chunk, columns), self._crew.kept(columns)))
        if self._chunk == 0:
            self._check_made(part)
        self._chunk += 1
        return _poorness(self._read(self._study.sought, part))

    def _check_kept(self, columns: Mapping[str, Sequence[Level]], part: slice) -> None:
        for name, values in self._study.layout.columns(columns).items():
            if not np.array_equal(self._read(name, part), values):
                what = "has runs of a search that went another way, as with another SciPy"
                raise InputError(what, key="store", hint="begin anew in another store")

    def _check_made(self, part: slice) -> None:
        if not (self._read("status", part) == GOOD).any():
            message = unpacked_message(self._read("message", part)[0])
            raise ComputationError(f"all of the first {part.stop} runs failed: {message}")


def _poorness(values: FloatArray) -> FloatArray:
    """Return what the search makes smallest.

    Neither a run that failed nor one without the result, as where nothing is hit, is a worst case.
    """
    return np.where(np.isnan(values), _POOR, -values.clip(-_POOR, _POOR))
