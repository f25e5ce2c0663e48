"""Sobol's indices of results whose runs were drawn for them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray

__all__ = ["PARTS", "Indices", "indices_of", "indices_of_runs"]

PARTS = {"first": "first-order index", "total": "total index"}
"""What is told of each result."""


class Indices(NamedTuple):
    """Sobol's indices of one result, (parameter,)."""

    first: FloatArray
    """The part of the variance that each parameter makes alone."""
    total: FloatArray
    """The part that it makes alone and together with others."""


def indices_of(one: FloatArray, other: FloatArray, mixed: FloatArray) -> Indices:
    """Return the indices of a result from its values.

    Parameters
    ----------
    one, other
        Its values for two samples, (run,).
    mixed
        Its values for the first sample with one parameter taken from the second, (parameter,
        run).

    References
    ----------
    A. Saltelli et al., *Computer Physics Communications* 181 (2010) 259, for the first-order
    indices; M. J. W. Jansen, *Computer Physics Communications* 117 (1999) 35, for the total ones.
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


def indices_of_runs(values: FloatArray, samples: int) -> Indices:
    """Return the indices of a result from its values in all runs of Saltelli's design.

    Parameters
    ----------
    values
        (run,), in the order of `bumpstop.study.sampling.unit_samples`.
    samples
        How many samples were drawn.
    """
    blocks = values.reshape(-1, samples)
    return indices_of(blocks[0], blocks[1], blocks[2:])
