"""The worst case: the values of parameters that make one result as large as it can be."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.arguments import FloatArray, count
from bumpstop.errors import ComputationError, InputError
from bumpstop.study.evaluation import FAILED, Evaluator
from bumpstop.study.outputs import Output
from bumpstop.study.sampling import Sampling
from bumpstop.study.study import Study

if TYPE_CHECKING:
    from bumpstop.io.case import Case
    from bumpstop.study.parameters import Level

__all__ = ["WorstCase", "worst_case"]

_CROWD = 8
"""Members of a generation for each parameter."""
_POOR = 1e150
"""What the search makes smallest, where there is no result."""


@dataclass(frozen=True)
class WorstCase:
    """What a search has found.

    Attributes
    ----------
    parameters
        The values of the parameters in the worst run.
    value
        The result there, in SI units.
    runs, failed
        How many runs the search took, and how many of these failed.
    """

    parameters: dict[str, Level]
    value: float
    runs: int
    failed: int


def worst_case(
    case: Case,
    parameters: Mapping[str, Any],
    output: Output,
    *,
    runs: int = 1000,
    seed: int = 0,
    variant: str | None = None,
) -> WorstCase:
    """Look for the values of parameters that make a result largest.

    Results of impacts have jumps and many local maxima, so that gradients mislead: the search
    is by differential evolution (R. Storn, K. Price, *Journal of Global Optimization* 11
    (1997) 341; `scipy.optimize.differential_evolution`). It proves no maximum; another seed or
    more runs may find a larger value.

    Parameters
    ----------
    case, parameters, variant
        See `Study`; within distributions, all shares from 0 to 1 are searched.
    output
        A single number.
    runs
        The most runs.
    seed
        Another seed searches on other ways, the same one on the same.

    Raises
    ------
    InputError
        If something is not as it must be, or the runs are too few to begin.
    ComputationError
        If none of the first runs could be made, or no run has the result, as where the stop
        whose impacts it is of is never hit.
    """
    from scipy.optimize import differential_evolution

    if output.shape:
        raise InputError("must be a single number", key="output.times", hint="give a statistic")
    first = Sampling("monte_carlo", 1, seed)
    study = Study(case, parameters, {"value": output}, sampling=first, variant=variant)
    # SciPy makes a generation of at least five members.
    generation = max(_CROWD * len(study.parameters), 5)
    if count("runs", runs) < generation:
        raise InputError(f"must be {generation} or more", key="runs", value=runs)
    search = _Search(study)
    differential_evolution(
        search,
        [(0.0, 1.0)] * len(study.parameters),
        popsize=_CROWD,
        maxiter=runs // generation - 1,
        seed=seed,
        tol=1e-9,
        polish=False,
        vectorized=True,
        updating="deferred",
    )
    if not search.parameters:
        what = output.attributes["long_name"]
        message = f"none of {search.runs} runs has a value of what is looked for: {what}"
        raise ComputationError(message)
    return WorstCase(search.parameters, search.value, search.runs, search.failed)


class _Search:
    """Makes the runs that a search asks for, and remembers the worst."""

    def __init__(self, study: Study) -> None:
        self._varied = study.varied
        self._evaluator = Evaluator(study.recipe)
        self.parameters: dict[str, Level] = {}
        self.value = -np.inf
        self.runs = self.failed = 0

    def __call__(self, shares: FloatArray) -> FloatArray:
        """Return what is to be made smallest, (run,), at shares (parameter, run)."""
        rows = zip(self._varied.items(), np.atleast_2d(shares), strict=True)
        columns = {name: each.quantiles(row).tolist() for (name, each), row in rows}
        kept = self._evaluator.kept(columns)
        self.runs += len(kept.status)
        self.failed += int(np.count_nonzero(kept.status == FAILED))
        if self.failed == self.runs:
            message = next(filter(None, kept.messages))
            raise ComputationError(f"all of the first {self.runs} runs failed: {message}")
        values = kept.values["value"]
        known = ~np.isnan(values)
        if known.any():
            largest = int(np.nanargmax(values))
            if values[largest] > self.value:
                self.value = float(values[largest])
                self.parameters = {name: column[largest] for name, column in columns.items()}
        # Neither a run that failed nor one without an impact is a worst case. That they differ
        # keeps a search from ending where there is none yet.
        poor = _POOR * (1.0 + np.arange(len(values)) / len(values))
        return np.where(known, -values.clip(-_POOR, _POOR), poor)
