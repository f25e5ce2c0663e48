"""Sobol's indices: which parameter the scatter of a result comes from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.errors import ComputationError, InputError
from bumpstop.study.indices import PARTS
from bumpstop.study.outputs import Output
from bumpstop.study.sampling import Sampling
from bumpstop.study.study import Study

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.io.case import Case

__all__ = ["sobol_indices"]


def sobol_indices(
    case: Case,
    parameters: Mapping[str, Any],
    outputs: Mapping[str, Output],
    *,
    count: int,
    seed: int = 0,
    variant: str | None = None,
    workers: int | None = None,
) -> xr.Dataset:
    """Return which parts of the variance of results come from which parameters.

    The runs are those of a study whose `Sampling` is ``"saltelli"``: ``count (2 + parameters)``.
    Such a study tells the same indices, and may have a store or a scheduler.

    Parameters
    ----------
    case, parameters, outputs, variant
        See `Study`. Parameters are drawn from ranges, distributions and lists; outputs are
        single numbers.
    count
        How many samples: a power of two.
    seed
        Another seed draws other samples.
    workers
        How many processes.

    Returns
    -------
    xarray.Dataset
        For each output ``NAME`` the indices ``NAME_first`` and ``NAME_total`` over
        ``parameter``.

    Raises
    ------
    InputError
        If something is not as it must be; see `Study`.
    ComputationError
        If a run failed, or has no such result, as where no impact happens: variances need all.

    References
    ----------
    A. Saltelli et al., *Computer Physics Communications* 181 (2010) 259, for the first-order
    indices; M. J. W. Jansen, *Computer Physics Communications* 117 (1999) 35, for the total ones.
    """
    for name, output in outputs.items():
        if output.shape:
            raise InputError("must be a single number", key=f"outputs.{name}.times")
    sampling = Sampling("saltelli", count, seed)
    study = Study(case, parameters, outputs, sampling=sampling, variant=variant)
    results = study.run(workers=workers)
    if results.failed.any():
        message = next(filter(None, results.message.values))
        raise ComputationError(f"{int(results.failed.sum())} runs failed: {message}")
    for name in outputs:
        missing = int(np.isnan(results[name].values).sum())
        if missing:
            message = f"{missing} of {study.runs.count} runs have no {name}"
            raise ComputationError(f"{message}: variances need all")
    indices: xr.Dataset = results[[f"{name}_{part}" for name in outputs for part in PARTS]]
    return indices
