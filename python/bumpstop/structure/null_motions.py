"""The motions that a given stiffness matrix does not resist."""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.echelon import independent_columns, null_space
from bumpstop.structure.graph import components
from bumpstop.structure.null_search import null_vectors
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["LARGEST_DENSE", "is_definite", "null_motions"]

LARGEST_DENSE = 3000
"""Most dofs that move together whose matrix is searched always, and by dense methods."""


def null_motions(
    stiffness: SparseMatrix, proposed: FloatArray, accuracy: float, *, search_large: bool = False
) -> FloatArray:
    """Return independent motions x with ``stiffness @ x = 0``, (dofs, motions).

    Dofs that the matrix does not couple are looked at apart. Combinations of the proposed
    motions come first; they are exact, whatever rounding the matrix carries.

    Parameters
    ----------
    stiffness
        Symmetric matrix on the free dofs.
    proposed
        Motions that may be free of strain, the rigid ones for example, (dofs, m).
    accuracy
        What is taken for zero, relative to the sum of the sizes of what adds up to it.
    search_large
        Search for motions that were not proposed also among more than ``LARGEST_DENSE`` dofs.

    Examples
    --------
    >>> import numpy as np
    >>> places = np.array([0, 0, 1, 1]), np.array([0, 1, 0, 1])
    >>> spring = SparseMatrix.from_triplets((2, 2), *places, np.array([3.0, -3.0, -3.0, 3.0]))
    >>> null_motions(spring, np.array([[1.0], [1.0]]), 1e-13)
    array([[1.],
           [1.]])
    """
    size = stiffness.shape[0]
    found = [np.zeros((size, 0))]
    for dofs in components(size, stiffness.rows, stiffness.columns):
        group = np.array(dofs)
        own = stiffness.restricted(group)
        motions = _group_motions(own, proposed[group], accuracy, search_large)
        found.append(np.zeros((size, motions.shape[1])))
        found[-1][group] = motions
    return np.hstack(found)


def _group_motions(
    stiffness: SparseMatrix, proposed: FloatArray, accuracy: float, search_large: bool
) -> FloatArray:
    known = _combinations(stiffness, proposed, accuracy)
    if stiffness.shape[0] > LARGEST_DENSE and not search_large:
        return known
    return np.hstack([known, _further(stiffness, known, accuracy)])


def _combinations(stiffness: SparseMatrix, proposed: FloatArray, accuracy: float) -> FloatArray:
    """Return the combinations of proposed motions that strain nothing."""
    motions = independent_columns(_unit_columns(proposed))
    forces = stiffness @ motions
    forces[np.abs(forces) <= accuracy * (stiffness.magnitudes() @ np.abs(motions))] = 0.0
    resisting = forces[np.any(forces != 0.0, axis=1)]
    if len(resisting) == 0:
        return motions
    # Each row to order one: a soft spring to the ground resists as surely as a stiff one.
    weights = null_space(resisting / np.abs(resisting).max(axis=1, keepdims=True))
    combined: FloatArray = motions @ weights
    return combined


def _further(stiffness: SparseMatrix, known: FloatArray, accuracy: float) -> FloatArray:
    """Return the motions that strain nothing and are no combination of those known."""
    scale = _unit_scale(stiffness)
    scaled = SparseMatrix(
        stiffness.shape,
        stiffness.starts,
        stiffness.rows,
        stiffness.values * scale[stiffness.rows] * scale[stiffness.columns],
    )
    size = float((scaled.magnitudes() @ np.ones(len(scale))).max())
    if size == 0.0:  # nothing holds on to this dof
        return np.eye(len(scale))[:, known.shape[1] :]
    directions = np.linalg.qr(known / scale[:, np.newaxis])[0]
    search = _dense_null_vectors if len(scale) <= LARGEST_DENSE else null_vectors
    return _unit_columns(scale[:, np.newaxis] * search(scaled, directions, accuracy * size))


def _dense_null_vectors(matrix: SparseMatrix, known: FloatArray, bound: float) -> FloatArray:
    """Return what ``null_vectors`` does, for a matrix small enough to be stored whole."""
    size = float(np.abs(matrix.values).max())
    stiffened = matrix.to_dense() + size * (known @ known.T)
    if _exceeds(stiffened, bound):
        return np.zeros((len(stiffened), 0))
    values, vectors = np.linalg.eigh(stiffened)
    found: FloatArray = vectors[:, np.abs(values) <= bound]
    return found


def is_definite(matrix: FloatArray, bound: float) -> bool:
    """Tell whether a symmetric matrix, scaled to unit diagonal, has its eigenvalues above a bound.

    Examples
    --------
    >>> is_definite(np.diag([2e6, 1e-6]), 0.5), is_definite(np.ones((2, 2)), 1e-9)
    (True, False)
    """
    diagonal = matrix.diagonal()
    scale = 1.0 / np.sqrt(np.where(diagonal != 0.0, np.abs(diagonal), 1.0))
    return _exceeds(matrix * np.outer(scale, scale), bound)


def _exceeds(matrix: FloatArray, bound: float) -> bool:
    """Tell whether all eigenvalues of a symmetric matrix exceed a bound."""
    try:
        np.linalg.cholesky(matrix - bound * np.eye(len(matrix)))
    except np.linalg.LinAlgError:
        return False
    return True


def _unit_scale(matrix: SparseMatrix) -> FloatArray:
    """Return factors that bring the diagonal near one, powers of two so that nothing rounds."""
    largest = np.zeros(matrix.shape[0])
    np.maximum.at(largest, matrix.rows, np.abs(matrix.values))
    size = np.sqrt(np.maximum(np.abs(matrix.diagonal()), 1e-6 * largest))
    scale: FloatArray = np.exp2(-np.round(np.log2(np.where(size > 0.0, size, 1.0))))
    return scale


def _unit_columns(matrix: FloatArray) -> FloatArray:
    largest = np.abs(matrix).max(axis=0, initial=0.0)
    kept: FloatArray = matrix[:, largest > 0.0] / largest[largest > 0.0]
    return kept
