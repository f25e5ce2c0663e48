"""The lowest modes of a structure."""

from __future__ import annotations

import numpy as np

from bumpstop._core import CoreError, symmetric_modes
from bumpstop.arguments import FloatArray
from bumpstop.errors import ComputationError, InputError
from bumpstop.modal.signs import largest_positive
from bumpstop.structure.echelon import independent_columns, null_space
from bumpstop.structure.graph import components
from bumpstop.structure.model import LinearModel
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["MOST_DOFS", "structure_modes"]

MOST_DOFS = 3000
"""Most free dofs that move together: their eigenproblem is solved with dense matrices."""


def structure_modes(model: LinearModel, count: int) -> tuple[FloatArray, FloatArray]:
    """Return the lowest modes: ``omega2`` (count,) in rad2/s2 and shapes (dofs, count).

    Rigid modes come first, with ``omega2`` exactly zero and the shapes of exact rigid
    motions; the flexible ones follow, mass-orthogonal to them. Modal masses are one, and the
    largest component of each shape is positive. Dofs that nothing couples (stretching, twist
    and bending of a straight beam in its two planes) are solved apart, so that modes of equal
    frequency do not mix.

    Raises
    ------
    InputError
        If there are fewer free dofs than modes, or too many dofs for dense matrices.
    """
    free = model.free
    if count > len(free):
        hint = f"the structure has {len(free)} free dofs"
        raise InputError("more modes than free dofs", key="modes", value=count, hint=hint)
    stiffness, mass = model.reduced(model.stiffness), model.reduced(model.mass)
    rigid = model.rigid_shapes()
    omega2, shapes = [np.zeros(0)], [np.zeros((len(free), 0))]
    for dofs in _uncoupled(stiffness, mass):
        values, vectors = _block_modes(
            stiffness.restricted(dofs).to_dense(),
            mass.restricted(dofs).to_dense(),
            rigid[dofs],
            count,
        )
        omega2.append(values)
        shapes.append(np.zeros((len(free), len(values))))
        shapes[-1][dofs] = vectors
    return _lowest(model, np.concatenate(omega2), np.hstack(shapes), count)


def _lowest(
    model: LinearModel, omega2: FloatArray, shapes: FloatArray, count: int
) -> tuple[FloatArray, FloatArray]:
    """Return the modes of lowest frequency, on all dofs of the model."""
    order = np.argsort(omega2, kind="stable")[:count]
    return omega2[order], largest_positive(model.expansion @ shapes[:, order])


def _uncoupled(stiffness: SparseMatrix, mass: SparseMatrix) -> list[IndexArray]:
    """Return the groups of dofs that neither matrix couples to others."""
    rows = np.concatenate([stiffness.rows, mass.rows])
    columns = np.concatenate([stiffness.columns, mass.columns])
    groups = components(mass.shape[0], rows, columns)
    largest = max(len(group) for group in groups)
    if largest > MOST_DOFS:
        raise InputError(
            f"{largest} free dofs move together, more than the {MOST_DOFS} that can be solved",
            hint="take fewer elements",
        )
    return [np.array(group) for group in groups]


def _block_modes(
    stiffness: FloatArray, mass: FloatArray, rigid: FloatArray, count: int
) -> tuple[FloatArray, FloatArray]:
    """Return up to ``count`` flexible modes, after all rigid ones, of one group of dofs."""
    # Unit-free dofs; powers of two, so that scaling rounds nothing.
    scale = 2.0 ** -np.round(0.5 * np.log2(mass.diagonal()))
    stiffness, mass = (matrix * np.outer(scale, scale) for matrix in (stiffness, mass))
    still = _orthonormal(independent_columns(_unit_columns(rigid / scale[:, np.newaxis])), mass)
    omega2, flexible = _flexible_modes(stiffness, mass, still, count)
    shapes = np.hstack([still, flexible]) * scale[:, np.newaxis]
    return np.concatenate([np.zeros(still.shape[1]), omega2]), shapes


def _flexible_modes(
    stiffness: FloatArray, mass: FloatArray, rigid: FloatArray, count: int
) -> tuple[FloatArray, FloatArray]:
    """Return the lowest modes that are mass-orthogonal to the rigid ones."""
    complement = null_space((mass @ rigid).T)
    count = min(count, complement.shape[1])
    if count == 0:
        return np.zeros(0), np.zeros((len(mass), 0))
    reduced_stiffness, reduced_mass = (
        _symmetric(complement.T @ matrix @ complement) for matrix in (stiffness, mass)
    )
    try:
        _, vectors = symmetric_modes(reduced_stiffness, reduced_mass, count)
    except CoreError as error:
        raise ComputationError(f"the modes could not be computed: {error}") from error
    shapes = complement @ vectors
    shapes -= rigid @ (rigid.T @ (mass @ shapes))
    shapes /= np.sqrt(np.sum(shapes * (mass @ shapes), axis=0))
    # Rayleigh quotients: their error is the square of that of the shapes.
    omega2: FloatArray = np.sum(shapes * (stiffness @ shapes), axis=0)
    return omega2, shapes


def _orthonormal(shapes: FloatArray, mass: FloatArray) -> FloatArray:
    """Return shapes with the same span and M-orthonormal, each made of those up to it."""
    for _ in range(2):  # once more removes what rounding left
        factor = np.linalg.cholesky(shapes.T @ mass @ shapes)
        shapes = np.linalg.solve(factor, shapes.T).T
    return shapes


def _unit_columns(matrix: FloatArray) -> FloatArray:
    largest = np.abs(matrix).max(axis=0)
    return matrix / np.where(largest > 0.0, largest, 1.0)


def _symmetric(matrix: FloatArray) -> FloatArray:
    symmetric: FloatArray = 0.5 * (matrix + matrix.T)
    return np.ascontiguousarray(symmetric)
