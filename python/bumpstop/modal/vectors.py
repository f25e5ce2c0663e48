"""From any vectors of a model to the canonical form: unit modal mass, diagonal stiffness."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from bumpstop._core import CoreError, symmetric_modes
from bumpstop.arguments import FloatArray
from bumpstop.errors import ComputationError
from bumpstop.modal.coordinates import UserCoordinates, scaled_coordinates
from bumpstop.modal.independent import independent_vectors, mass_norms, without
from bumpstop.modal.signs import largest_positive
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["RIGID", "CanonicalVectors", "canonical_vectors"]

DIAGONAL = 1e-11
"""Terms off the diagonal below this, relative to those on it, are rounding."""
RIGID = 1e-6
"""A vector this close to a rigid motion, in the norm of the mass matrix, is one."""
ROUNDING = 8.0 * np.finfo(float).eps


class CanonicalVectors(NamedTuple):
    """Vectors of unit modal mass between which neither mass nor stiffness couples."""

    omega2: FloatArray
    """Stiffness of each in rad2/s2, (N,); exactly zero for rigid motions."""
    shapes: FloatArray
    """One a column, (n, N)."""
    coordinates: UserCoordinates | None
    """How they are made of the vectors given; None where they are those vectors."""
    dropped: dict[int, str]
    """Which of the vectors given are left out, and that they are and why."""


def canonical_vectors(
    vectors: FloatArray, stiffness: SparseMatrix, mass: SparseMatrix, rigid: FloatArray
) -> CanonicalVectors:
    """Return vectors with the same span, of unit modal mass and with a diagonal stiffness.

    Vectors that are so already are left as they are, bit by bit and in their order. From
    others, the rigid motions among their combinations come first, exact; the flexible ones
    follow by rising frequency, the largest component of each positive.

    Parameters
    ----------
    vectors
        One a column, (n, count); at least one of them has a mass.
    stiffness, mass
        Symmetric matrices, (n, n).
    rigid
        All motions that strain nothing, (n, r).
    """
    rigid = independent_vectors(rigid, mass).vectors
    as_given = _if_diagonal(vectors, stiffness, mass, rigid)
    if as_given is not None:
        return as_given
    independent, kept = independent_vectors(vectors, mass)
    still, rest = _split(independent, mass, rigid)
    flexible = _uncoupled(rest, stiffness)
    shapes = np.hstack([still, largest_positive(flexible)])
    omega2 = np.concatenate([np.zeros(still.shape[1]), _energies(flexible, stiffness)])
    # K counts what the kept vectors are made of: kept = independent @ K, upper triangular.
    weighted = mass @ vectors
    made_of = independent.T @ weighted[:, kept]
    from_canonical = np.zeros((vectors.shape[1], len(kept)))
    from_canonical[kept] = np.linalg.solve(made_of, independent.T @ (mass @ shapes))
    coordinates = UserCoordinates(shapes.T @ weighted, from_canonical)
    dropped = {
        number: f"is left out: it {'depends on those before it' if norm else 'moves no mass'}"
        for number, norm in enumerate(mass_norms(vectors, mass))
        if number not in kept
    }
    return CanonicalVectors(omega2, shapes, coordinates, dropped)


def _if_diagonal(
    vectors: FloatArray, stiffness: SparseMatrix, mass: SparseMatrix, rigid: FloatArray
) -> CanonicalVectors | None:
    """Return the vectors, scaled where they need it, if nothing couples them."""
    modal_mass = vectors.T @ (mass @ vectors)
    norms = np.sqrt(np.maximum(modal_mass.diagonal(), 0.0))
    if not norms.all():
        return None
    scale = np.where(np.abs(norms - 1.0) <= DIAGONAL, 1.0, norms)
    shapes = vectors / scale
    modal_mass /= np.outer(norms, norms)
    modal_stiffness = shapes.T @ (stiffness @ shapes)
    own = np.sqrt(np.abs(modal_stiffness.diagonal()))
    noise = np.sqrt(_cancelled(shapes, stiffness))
    couples = np.abs(modal_stiffness) > DIAGONAL * np.outer(own, own) + np.outer(noise, noise)
    couples |= np.abs(modal_mass) > DIAGONAL
    if couples[~np.eye(len(norms), dtype=bool)].any():
        return None
    omega2 = _energies(shapes, stiffness)
    omega2[mass_norms(without(rigid, shapes, mass), mass) <= RIGID] = 0.0
    return CanonicalVectors(omega2, shapes, scaled_coordinates(scale), {})


def _split(
    vectors: FloatArray, mass: SparseMatrix, rigid: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Return the rigid motions in the span of orthonormal vectors, exact, and the rest of it.

    The angles between two spans are those of the singular values of their inner products
    (Bjorck and Golub, Mathematics of Computation 27 (1973), 579-594).
    """
    if rigid.shape[1] == 0:
        return rigid, vectors
    inner = rigid.T @ (mass @ vectors)
    left, _, right = np.linalg.svd(inner)
    near = right[: min(inner.shape)].T
    apart = mass_norms(without(rigid, vectors @ near, mass), mass)
    found = np.flatnonzero(apart <= RIGID)
    # Where all motions are found they are kept as they are, plain translations and rotations.
    still = rigid if len(found) == rigid.shape[1] else rigid @ left[:, found]
    others = np.delete(right, found, axis=0).T
    rest = without(still, vectors @ others, mass)
    return still, independent_vectors(without(still, rest, mass), mass).vectors


def _uncoupled(vectors: FloatArray, stiffness: SparseMatrix) -> FloatArray:
    """Turn orthonormal vectors among themselves so that the stiffness does not couple them."""
    count = vectors.shape[1]
    if count == 0:
        return vectors
    reduced = vectors.T @ (stiffness @ vectors)
    symmetric = np.ascontiguousarray(0.5 * (reduced + reduced.T))
    try:
        _, turned = symmetric_modes(symmetric, np.eye(count), count)
    except CoreError as error:
        raise ComputationError(f"the vectors could not be uncoupled: {error}") from error
    uncoupled: FloatArray = vectors @ turned
    return uncoupled


def _energies(shapes: FloatArray, stiffness: SparseMatrix) -> FloatArray:
    """Return the stiffness of each shape; exactly zero where rounding could have made it."""
    energies: FloatArray = np.sum(shapes * (stiffness @ shapes), axis=0)
    energies[np.abs(energies) <= _cancelled(shapes, stiffness)] = 0.0
    return energies


def _cancelled(shapes: FloatArray, stiffness: SparseMatrix) -> FloatArray:
    """Return how large rounding can be in the stiffness of each shape."""
    sizes = np.abs(shapes)
    noise: FloatArray = ROUNDING * np.sum(sizes * (stiffness.magnitudes() @ sizes), axis=0)
    return noise
