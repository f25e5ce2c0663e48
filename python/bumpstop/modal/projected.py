"""Matrices of a model as its modes see them."""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["projected"]

ROUNDING = 64.0 * np.finfo(float).eps
UNCOUPLED = 1e-10
"""Symmetric terms off the diagonal below this, relative to those on it, are rounding."""


def projected(matrix: SparseMatrix, shapes: FloatArray, *, skew: bool = False) -> FloatArray | None:
    """Return ``shapes' matrix shapes``, or None where nothing of it is left.

    Terms that are nothing but rounding, beside the sizes of what they are summed from, become
    exactly zero; the result is exactly symmetric or skew.

    Parameters
    ----------
    matrix
        Symmetric or skew-symmetric, (n, n).
    shapes
        One a column, (n, N).
    skew
        Whether the matrix is skew-symmetric.
    """
    if not matrix.values.any():
        return None
    terms = shapes.T @ (matrix @ shapes)
    terms = 0.5 * (terms - terms.T if skew else terms + terms.T)
    sizes = np.abs(shapes)
    negligible = ROUNDING * (sizes.T @ (matrix.magnitudes() @ sizes))
    own = np.sqrt(np.abs(terms.diagonal()))
    negligible = np.maximum(negligible, UNCOUPLED * np.outer(own, own))
    terms[np.abs(terms) <= np.maximum(negligible, negligible.T)] = 0.0
    return terms if terms.any() else None
