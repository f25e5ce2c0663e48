"""The modes of dofs that move together: dense matrices for few of them, sparse for many."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from bumpstop._core import CoreError, sparse_modes, sturm_count, symmetric_modes
from bumpstop.arguments import FloatArray
from bumpstop.errors import ComputationError, InputError
from bumpstop.modal.independent import independent_vectors
from bumpstop.modal.selected import Range, omega2_of, range_of
from bumpstop.modal.selection import AllModes, LowestModes, ModesAround, ModeSelection
from bumpstop.structure.echelon import independent_columns, null_space
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["FEW", "MOST_COMPLETE", "CoupledModes", "coupled_modes"]

FEW = 200
"""So many dofs are solved faster with dense matrices than with sparse ones."""
MOST_COMPLETE = 5000
"""Most dofs that move together of which all modes can be had: it takes dense matrices."""
WIDEST = 1e-9
"""Lowest eigenvalue over the highest for which dense matrices are solved as they are."""
CUTS = 8
"""Places at which counts prove all modes of a model."""
APART = 1e-6
"""How far apart eigenvalues are between which it is cut, relative to the higher one."""


class CoupledModes(NamedTuple):
    """All modes of a range, which holds those asked for."""

    omega2: FloatArray
    """Squared angular frequencies in rad2/s2, ascending, (m,)."""
    shapes: FloatArray
    """One a column, unit modal mass, (dofs, m)."""
    within: Range
    """The range."""
    proven: bool
    """Whether the inertia tells as many modes in it."""


def coupled_modes(
    stiffness: SparseMatrix, mass: SparseMatrix, rigid: FloatArray, selection: ModeSelection
) -> CoupledModes:
    """Return modes of dofs that are coupled, all those of a range with the selected in it.

    Parameters
    ----------
    stiffness, mass
        Symmetric matrices (n, n).
    rigid
        Motions that span all those without strain, (n, r); some may be zero here.
    selection
        What is asked for; fewer where there are not as many.
    """
    # Unit-free dofs; powers of two, so that scaling rounds nothing.
    scale = 2.0 ** -np.round(0.5 * np.log2(mass.diagonal()))
    still = _unit_columns(rigid / scale[:, np.newaxis])
    solve = _dense_modes if _is_small(mass.shape[0], selection) else _sparse_modes
    try:
        found = solve(_scaled(stiffness, scale), _scaled(mass, scale), still, selection)
    except CoreError as error:
        raise ComputationError(f"the modes could not be computed: {error}") from error
    return found._replace(shapes=found.shapes * scale[:, np.newaxis])


def _is_small(size: int, selection: ModeSelection) -> bool:
    """Tell whether dense matrices are the better way."""
    if size <= FEW:
        return True
    if isinstance(selection, LowestModes | ModesAround):
        return size <= MOST_COMPLETE and 4 * selection.count > size
    if isinstance(selection, AllModes) and size > MOST_COMPLETE:
        raise InputError(
            f"{size} free dofs move together, of which all modes cannot be had",
            key="modes",
            hint=f"ask for some of them, or take fewer elements: {MOST_COMPLETE} dofs can be done",
        )
    return isinstance(selection, AllModes)


def _sparse_modes(
    stiffness: SparseMatrix, mass: SparseMatrix, rigid: FloatArray, selection: ModeSelection
) -> CoupledModes:
    still = independent_vectors(rigid, mass).vectors
    matrices = stiffness.arrays, mass.arrays, still
    if isinstance(selection, LowestModes):
        found = sparse_modes(*matrices, lowest=selection.count)
    elif isinstance(selection, ModesAround):
        around = omega2_of(selection.frequency), selection.count
        found = sparse_modes(*matrices, around=around)
    else:
        assert not isinstance(selection, AllModes)
        found = sparse_modes(*matrices, band=(omega2_of(selection.low), omega2_of(selection.high)))
    values, shapes, low, high = found
    within = Range(-math.inf if low is None else low[0], high[0])
    return _in_order(still, values, shapes, within, proven=True)


def _dense_modes(
    stiffness: SparseMatrix, mass: SparseMatrix, rigid: FloatArray, selection: ModeSelection
) -> CoupledModes:
    dense_stiffness, dense_mass = stiffness.to_dense(), mass.to_dense()
    still = _orthonormal(independent_columns(rigid), dense_mass)
    complement = null_space((dense_mass @ still).T)
    reduced_stiffness, reduced_mass = (
        _symmetric(complement.T @ matrix @ complement) for matrix in (dense_stiffness, dense_mass)
    )
    most = complement.shape[1]
    count = min(selection.count, most) if isinstance(selection, LowestModes) else most
    values, vectors = _lowest(reduced_stiffness, reduced_mass, count)
    everything = np.sort(np.concatenate([np.zeros(still.shape[1]), values]))
    within = range_of(selection, everything)
    needed = int(np.count_nonzero(values < within.high))
    if needed > count:
        _, vectors = _solved(reduced_stiffness, reduced_mass, needed)
    shapes = complement @ vectors
    shapes -= still @ (still.T @ (dense_mass @ shapes))
    shapes /= np.sqrt(np.sum(shapes * (dense_mass @ shapes), axis=0))
    # Rayleigh quotients: their error is the square of that of the shapes.
    omega2 = np.sum(shapes * (dense_stiffness @ shapes), axis=0)
    proven = all(
        _count(stiffness, mass, part) == len(part.holds(everything))
        for part in _countable(within, everything)
    )
    return _in_order(still, omega2, shapes, within, proven=proven)


def _lowest(stiffness: FloatArray, mass: FloatArray, count: int) -> tuple[FloatArray, FloatArray]:
    """Return all eigenvalues of dense matrices and the ``count`` lowest shapes.

    Beside very stiff or nearly massless parts, which put the highest eigenvalues out of all
    proportion, the lowest are lost in rounding. Those that can be told from each other are then
    found by themselves, and the others among the motions that are M-orthogonal to them.
    """
    values, shapes = _solved(stiffness, mass, count)
    if len(values) == 0 or values[0] > WIDEST * np.abs(values).max():
        return values, shapes
    try:
        np.linalg.cholesky(stiffness)
    except np.linalg.LinAlgError:  # unstable: the lowest eigenvalues are not small but negative
        return values, shapes
    values, shapes, apart = _bounded(stiffness, mass, count)
    if count <= apart:
        return values, shapes
    low = shapes[:, :apart]
    others = null_space((mass @ low).T)
    above, high = _lowest(
        _symmetric(others.T @ stiffness @ others),
        _symmetric(others.T @ mass @ others),
        count - apart,
    )
    return np.concatenate([values[:apart], above]), np.hstack([low, others @ high])


def _bounded(
    stiffness: FloatArray, mass: FloatArray, count: int
) -> tuple[FloatArray, FloatArray, int]:
    """Return all eigenvalues, the ``count`` lowest shapes, and how many can be told apart.

    A little of the stiffness is added to the mass: the shapes of K x = lambda (M + e K) x are
    those of K x = omega2 M x, with lambda = omega2 / (1 + e omega2), which cannot exceed 1 / e.
    """
    # The trace is the sum of all 1 / omega2; a power of two, so that no rounding depends on it.
    lowest = 1.0 / float(np.linalg.solve(stiffness, mass).trace())
    part = 2.0 ** round(math.log2(WIDEST / lowest))
    bounded, shapes = symmetric_modes(stiffness, mass + part * stiffness, count)
    # Motions without mass, within rounding: no frequency is too high for them.
    values = np.full(len(mass), math.inf)
    np.divide(bounded, 1.0 - part * bounded, out=values, where=part * bounded < 1.0)
    return values, shapes, int(np.count_nonzero(part * bounded < 0.5))


def _solved(stiffness: FloatArray, mass: FloatArray, count: int) -> tuple[FloatArray, FloatArray]:
    """Return all eigenvalues of dense matrices and the ``count`` lowest shapes."""
    if len(mass) == 0:
        return np.zeros(0), np.zeros((0, 0))
    return symmetric_modes(stiffness, mass, count)


def _in_order(
    still: FloatArray, omega2: FloatArray, flexible: FloatArray, within: Range, *, proven: bool
) -> CoupledModes:
    """Return rigid and flexible modes of a range by their frequencies, rigid ones first."""
    values = np.concatenate([np.zeros(still.shape[1]), omega2])
    inside = within.holds(values)
    order = inside[np.argsort(values[inside], kind="stable")]
    return CoupledModes(values[order], np.hstack([still, flexible])[:, order], within, proven)


def _countable(within: Range, values: FloatArray) -> list[Range]:
    """Return ranges whose counts prove the values: there is nothing to count in one without ends.

    That one is cut where neighbours are apart, at a few places from the lowest to the highest.
    """
    if not all(map(math.isinf, within)):
        return [within]
    known = values[np.isfinite(values)]
    places = np.flatnonzero(np.diff(known) > APART * np.abs(known[1:]))
    few = places[np.linspace(0, len(places) - 1, min(len(places), CUTS), dtype=np.intp)]
    return [Range(-math.inf, cut) for cut in (0.5 * (known[few] + known[few + 1])).tolist()]


def _count(stiffness: SparseMatrix, mass: SparseMatrix, within: Range) -> int | None:
    """Return the number of modes that the inertia tells in a range, where it can."""
    below = [0, mass.shape[0]]
    for number, end in enumerate(within):
        if math.isfinite(end):
            try:
                _, below[number] = sturm_count(stiffness.arrays, mass.arrays, [end])
            except CoreError:
                return None
    return below[1] - below[0]


def _scaled(matrix: SparseMatrix, scale: FloatArray) -> SparseMatrix:
    """Return the matrix with its rows and columns multiplied."""
    values = matrix.values * scale[matrix.rows] * scale[matrix.columns]
    return SparseMatrix(matrix.shape, matrix.starts, matrix.rows, values)


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
