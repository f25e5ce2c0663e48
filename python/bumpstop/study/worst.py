"""The worst case: the values of parameters that make one result as large as it can be."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.errors import ComputationError, InputError
from bumpstop.io.case.keys import keyed
from bumpstop.study.outputs import Output
from bumpstop.study.sampling import Sampling
from bumpstop.study.study import Study

if TYPE_CHECKING:
    from bumpstop.io.case import Case
    from bumpstop.study.parameters import Level

__all__ = ["WorstCase", "worst_case"]


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
    workers: int | None = None,
) -> WorstCase:
    """Look for the values of parameters that make a result largest.

    Results of impacts have jumps and many local maxima, so that gradients mislead: the search
    is by differential evolution, as `Sampling` has it with ``"worst_case"``. It proves no
    maximum; another seed or more runs may find a larger value.

    Parameters
    ----------
    case, parameters, variant
        See `Study`; within distributions, all shares from 0 to 1 are searched.
    output
        A single number.
    runs
        The most runs: as many whole generations as they are enough for.
    seed
        Another seed searches on other ways, the same one on the same.
    workers
        See `Study.run`.

    Raises
    ------
    InputError
        If something is not as it must be, or the runs are too few to begin.
    ComputationError
        If none of the first runs could be made, or no run has the result, as where the stop
        whose impacts it is of is never hit.
    """
    if not isinstance(output, Output):
        raise InputError("must be an Output", key="output", value=output)
    if output.shape:
        raise InputError("must be a single number", key="output.times", hint="give a statistic")
    with keyed(renamed={"count": "runs"}):
        sampling = Sampling("worst_case", runs, seed)
        study = Study(case, parameters, {"value": output}, sampling=sampling, variant=variant)
    results = study.run(workers=workers)
    values = results["value"].values
    if np.isnan(values).all():
        what = output.attributes["long_name"]
        message = f"none of {len(values)} runs has a value of what is looked for: {what}"
        raise ComputationError(message)
    worst = int(np.nanargmax(values))
    failed = int(np.count_nonzero(results["failed"].values))
    return WorstCase(study.runs.row(worst), float(values[worst]), len(values), failed)
