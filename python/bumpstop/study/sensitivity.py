"""Sobol's indices: which parameter the scatter of a result comes from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import ComputationError, InputError
from bumpstop.study.outputs import Output
from bumpstop.study.parameters import Parameter
from bumpstop.study.sampling import Sampling, unit_samples
from bumpstop.study.study import Study

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.io.case import Case

__all__ = ["Indices", "indices_of", "sobol_indices"]


class Indices(NamedTuple):
    """Sobol's indices of one result, (parameter,)."""

    first: FloatArray
    """The part of the variance that each parameter makes alone."""
    total: FloatArray
    """The part that it makes alone and together with others."""


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

    Two samples of all parameters are drawn (halves of one of Sobol's), and for each parameter one
    more, in which it alone is that of the second: ``count (2 + parameters)`` runs.

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
    import xarray as xr

    for name, output in outputs.items():
        if output.shape:
            raise InputError("must be a single number", key=f"outputs.{name}.times")
    sampling = Sampling("sobol", count, seed)
    varied = Study(case, parameters, outputs, sampling=sampling, variant=variant).varied
    study = Study(
        case,
        _columns(varied, sampling),
        outputs,
        sampling=Sampling("list"),
        variant=variant,
    )
    results = study.run(workers=workers)
    if results.failed.any():
        message = next(filter(None, results.message.values))
        raise ComputationError(f"{int(results.failed.sum())} runs failed: {message}")
    found: dict[str, Any] = {}
    for name in outputs:
        values = results[name].values
        if np.isnan(values).any():
            message = f"{int(np.isnan(values).sum())} of {len(values)} runs have no {name}"
            raise ComputationError(f"{message}: variances need all")
        blocks = values.reshape(-1, count)
        first, total = indices_of(blocks[0], blocks[1], blocks[2:])
        found[f"{name}_first"] = ("parameter", first, {"long_name": "first-order index"})
        found[f"{name}_total"] = ("parameter", total, {"long_name": "total index"})
    return xr.Dataset(found, coords={"parameter": list(parameters)})


def indices_of(one: FloatArray, other: FloatArray, mixed: FloatArray) -> Indices:
    """Return the indices of a result from its values.

    Parameters
    ----------
    one, other
        Its values for two samples, (run,).
    mixed
        Its values for the first sample with one parameter taken from the second, (parameter,
        run).
    """
    both = np.concatenate([one, other])
    variance = both.var()
    if variance == 0.0:
        return Indices(*np.full((2, len(mixed)), np.nan))
    # Less its mean, which the estimator does not need but loses digits by.
    centred = other - both.mean()
    first = (centred * (mixed - one)).mean(axis=1) / variance
    total = ((one - mixed) ** 2).mean(axis=1) / (2.0 * variance)
    return Indices(first, total)


def _columns(parameters: Mapping[str, Parameter], sampling: Sampling) -> dict[str, Sequence[Any]]:
    """Return the values of each parameter in all runs, block after block."""
    names = list(parameters)
    one, other = np.split(unit_samples(sampling, 2 * len(names)), 2, axis=1)
    columns = {}
    for number, name in enumerate(names):
        blocks = [one[:, number], other[:, number], *(one[:, number] for _ in names)]
        blocks[2 + number] = other[:, number]
        columns[name] = parameters[name].quantiles(np.concatenate(blocks)).tolist()
    return columns
