"""Vectors that add something to those before them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["NEGLIGIBLE", "Independent", "independent_vectors", "mass_norms", "without"]

NEGLIGIBLE = 1e-9
"""A vector of which less than this is new, in the norm of the mass matrix, is dependent."""


class Independent(NamedTuple):
    """Vectors of unit modal mass, orthogonal to each other, and where they come from."""

    vectors: FloatArray
    """One a column, (n, m)."""
    kept: list[int]
    """Which of the vectors given are independent of those before them, (m,)."""


def independent_vectors(vectors: FloatArray, mass: SparseMatrix) -> Independent:
    """Make vectors orthonormal in the mass matrix, leaving out those that add nothing.

    The m-th result is made of the first m kept vectors (Gram-Schmidt, twice: once more
    removes what rounding left).

    Parameters
    ----------
    vectors
        One a column, (n, count).
    mass
        Mass matrix (n, n).
    """
    found = np.zeros(vectors.shape)
    kept: list[int] = []
    for number, norm in enumerate(mass_norms(vectors, mass)):
        before = found[:, : len(kept)]
        rest = without(before, vectors[:, number : number + 1], mass)
        new = mass_norms(rest, mass)
        if new <= NEGLIGIBLE * norm:
            continue
        rest = without(before, rest / new, mass)
        found[:, len(kept)] = (rest / mass_norms(rest, mass))[:, 0]
        kept.append(number)
    return Independent(found[:, : len(kept)], kept)


def without(basis: FloatArray, vectors: FloatArray, mass: SparseMatrix) -> FloatArray:
    """Return what vectors have beyond a basis that is orthonormal in the mass matrix."""
    return vectors - basis @ (basis.T @ (mass @ vectors))


def mass_norms(vectors: FloatArray, mass: SparseMatrix) -> FloatArray:
    """Return the length of each vector in the mass matrix."""
    squares = np.sum(vectors * (mass @ vectors), axis=0)
    norms: FloatArray = np.sqrt(np.maximum(squares, 0.0))
    return norms
