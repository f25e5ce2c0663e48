"""Null vectors of a large sparse matrix, by inverse iteration on a block.

The matrix, of about unit diagonal, is shifted by far more than its rounding and far less than
its lowest eigenvalues that are not zero; each solution with it then leaves next to nothing but
null vectors (B. N. Parlett, The Symmetric Eigenvalue Problem, SIAM 1998, section 4.3).
"""

from __future__ import annotations

import numpy as np

from bumpstop._core import CoreError, SparseFactor
from bumpstop.arguments import FloatArray
from bumpstop.errors import ComputationError
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["null_vectors"]

_SHIFT = 1e-11
"""Relative to the size of the matrix."""

_STEPS = 6
_FIRST_BLOCK = 8


def null_vectors(matrix: SparseMatrix, known: FloatArray, bound: float) -> FloatArray:
    """Return orthonormal eigenvectors whose eigenvalues are at most ``bound`` in size.

    Parameters
    ----------
    matrix
        Symmetric, (n, n), of about unit diagonal.
    known
        Orthonormal null vectors to which those returned are orthogonal, (n, r).
    bound
        What is taken for zero.

    Raises
    ------
    ComputationError
        If the shifted matrix cannot be factored.
    """
    size = matrix.shape[0]
    diagonal = np.arange(size)
    shifted = SparseMatrix.from_triplets(
        matrix.shape,
        np.concatenate([matrix.rows, diagonal]),
        np.concatenate([matrix.columns, diagonal]),
        np.concatenate([matrix.values, np.full(size, _SHIFT)]),
    )
    try:
        factor = SparseFactor((shifted.starts, shifted.rows, shifted.values))
    except CoreError as error:
        raise ComputationError(f"the stiffness matrix cannot be factored: {error}") from error
    width = _FIRST_BLOCK
    while True:
        block = _lowest(matrix, factor, known, min(width, size - known.shape[1]))
        values, turns = np.linalg.eigh(block.T @ (matrix @ block))
        null = np.abs(values) <= bound
        if not null.all() or width >= size - known.shape[1]:
            found: FloatArray = block @ turns[:, null]
            return found
        width *= 2


def _lowest(
    matrix: SparseMatrix, factor: SparseFactor, known: FloatArray, width: int
) -> FloatArray:
    """Return an orthonormal block near the lowest eigenvectors, (n, width)."""
    block = np.random.default_rng(0).random((matrix.shape[0], width)) - 0.5
    for _ in range(_STEPS):
        block = factor.solve(np.ascontiguousarray(block))
        block = np.linalg.qr(block / np.abs(block).max(axis=0))[0]
        block = np.linalg.qr(block - known @ (known.T @ block))[0]
    return block
