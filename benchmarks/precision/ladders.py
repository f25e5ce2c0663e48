"""Ladders of steps or tolerances, and what is read from them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import process_time

import numpy as np

from benchmarks.precision.problems import Watched
from bumpstop._core import CoreError
from tests.reference.problem import Array

REPEATS = 2
LONGEST = 0.3
"""Processor time in s of a run after which a ladder ends."""


@dataclass(frozen=True)
class Solver:
    """A solver with its ladder, from coarse to fine."""

    name: str
    rungs: Sequence[float]
    run: Callable[[float], Array]
    """Gives the watched displacement at the instants for a step or tolerance."""
    has_order: bool = False
    """Whether rungs are steps."""


@dataclass(frozen=True)
class Ladder:
    """What a solver reached."""

    name: str
    rungs: list[float]
    errors: list[float]
    seconds: list[float]
    has_order: bool

    def work_for(self, error: float) -> float | None:
        """Return the least processor time that reached an error, if one did."""
        reached = [
            seconds
            for found, seconds in zip(self.errors, self.seconds, strict=True)
            if found <= error
        ]
        return min(reached) if reached else None

    @property
    def least(self) -> float:
        """The least error."""
        return min(self.errors)

    @property
    def order(self) -> float | None:
        """The slope of the errors over the steps, by least squares where they are small."""
        pairs = [
            (math.log(rung), math.log(error))
            for rung, error in zip(self.rungs, self.errors, strict=True)
            if 1e-9 < error < 3e-2
        ]
        if not self.has_order or len(pairs) < 3:
            return None
        steps, errors = np.array(pairs).T
        return float(np.polyfit(steps, errors, 1)[0])


def climbed(solver: Solver, problem: Watched) -> Ladder:
    """Climb a ladder."""
    rungs, errors, times = [], [], []
    for rung in solver.rungs:
        try:
            seconds, found = _timed(solver, rung)
        except CoreError:  # steps so coarse that nothing can be computed
            continue
        rungs.append(rung)
        errors.append(problem.error(found) if np.isfinite(found).all() else math.inf)
        times.append(seconds)
        if seconds > LONGEST:
            break
    return Ladder(solver.name, rungs, errors, times, solver.has_order)


def _timed(solver: Solver, rung: float) -> tuple[float, Array]:
    best = math.inf
    for _ in range(REPEATS):
        start = process_time()
        found = solver.run(rung)
        best = min(best, process_time() - start)
        if best > LONGEST / REPEATS:
            break
    return best, found
