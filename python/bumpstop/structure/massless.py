"""Motions without inertia: left out where nothing resists them, else in equilibrium always.

The node of a mass and of springs has six dofs, few of which are meant to move. A motion that
has no inertia and that no part resists is left out. One that a spring resists follows the rest
without delay, as its forces are in balance at every instant: with the massless motions Z,
Z' K x = 0 makes some dofs dependent on the others (static condensation, R. J. Guyan,
"Reduction of stiffness and mass matrices", AIAA Journal 3 (1965) 380), and is exact.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.structure.assembly import Contribution
from bumpstop.structure.echelon import independent_rows, null_space
from bumpstop.structure.elimination import Freedom
from bumpstop.structure.graph import components
from bumpstop.structure.mesh import Mesh
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = [
    "MOST_CONDENSED",
    "condensed",
    "idle_motions",
    "massless_motions",
    "surely_massive",
    "without",
]

MOST_CONDENSED = 3000
"""Most massless motions that hang together: they are solved for with dense matrices."""

_Sums: TypeAlias = tuple[IndexArray, IndexArray, FloatArray]
"""Free dofs, the others that they are sums of, and the weights, (dofs, others)."""


def surely_massive(mesh: Mesh, parts: Sequence[Contribution]) -> NDArray[np.bool_]:
    """Return which dofs have inertia in whatever way they move with others, (dofs,)."""
    massive = np.zeros((len(mesh.names), 6), dtype=bool)
    for part in parts:
        if part.has("mass"):
            own = part.massive()
            massive.flat[mesh.dofs_of(part.nodes).reshape(-1, len(own))[:, own]] = True
    return massive.ravel()


def massless_motions(
    freedom: Freedom, mass: SparseMatrix, massive: NDArray[np.bool_]
) -> SparseMatrix:
    """Return the motions of the free dofs that have no inertia, (free dofs, motions).

    A free dof that moves a surely massive one by itself has inertia in any motion. What is
    left is looked at in groups that the mass matrix couples.
    """
    expansion = freedom.expansion
    alone = np.bincount(expansion.rows, minlength=len(massive)) == 1
    doubtful = np.ones(len(freedom.free), dtype=bool)
    doubtful[expansion.columns[(alone & massive)[expansion.rows]]] = False
    dofs = np.flatnonzero(doubtful)
    choice = SparseMatrix.selection(len(doubtful), dofs)
    return choice.times(_null_motions(freedom.reduced(mass).restricted(dofs)))


def idle_motions(motions: SparseMatrix, stiffness: SparseMatrix) -> SparseMatrix:
    """Return the massless motions that nothing resists, (free dofs, motions)."""
    return motions.times(_null_motions(stiffness.congruent(motions)))


def without(freedom: Freedom, idle: SparseMatrix, scale: FloatArray) -> Freedom:
    """Return what can move when some motions of the free dofs cannot.

    A motion of one dof holds it. One of several leaves what is orthogonal to it: a body that
    cannot spin about a slanting axis turns about the axes across that one.

    Parameters
    ----------
    freedom
        What can move.
    idle
        The motions that cannot, (free dofs, motions).
    scale
        Size of a typical motion of each free dof, in which they are measured.
    """
    single = np.diff(idle.starts) == 1
    is_held = np.zeros(idle.shape[0], dtype=bool)
    is_held[idle.rows[single[idle.columns]]] = True
    held = np.flatnonzero(is_held)
    dofs, motions = idle.dense_columns(np.flatnonzero(~single))
    dofs, motions = dofs[~is_held[dofs]], motions[~is_held[dofs]]
    size = scale[dofs, np.newaxis]
    pivots = np.zeros(len(dofs), dtype=bool)
    pivots[independent_rows(motions / size)] = True
    weights = (motions / size**2).T
    sums = -np.array(np.linalg.solve(weights[:, pivots], weights[:, ~pivots]))
    nothing = held[:0], np.zeros((len(held), 0))
    return _told_by_others(freedom, [(held, *nothing), (dofs[pivots], dofs[~pivots], sums)])


def condensed(freedom: Freedom, motions: SparseMatrix, stiffness: SparseMatrix) -> Freedom:
    """Return what can move when massless motions are in equilibrium at every instant.

    Parameters
    ----------
    freedom
        What can move.
    motions
        Motions of the free dofs without inertia that are all resisted, (free dofs, motions).
    stiffness
        Stiffness of the free dofs.

    Raises
    ------
    InputError
        If too many of them hang together.
    """
    balance = stiffness.times(motions)
    diagonal = stiffness.diagonal()
    return _told_by_others(
        freedom,
        [_equilibrium(group, motions, balance, diagonal) for group in _groups(motions, balance)],
    )


def _told_by_others(freedom: Freedom, sums: Sequence[_Sums]) -> Freedom:
    """Return what can move when some free dofs are sums of others."""
    size = len(freedom.free)
    independent = np.ones(size, dtype=bool)
    rows, columns, weights = [], [], []
    for solved, others, sum_ in sums:
        independent[solved] = False
        rows.append(np.repeat(solved, len(others)))
        columns.append(np.tile(others, len(solved)))
        weights.append(sum_.ravel())
    kept = np.flatnonzero(independent)
    place = np.cumsum(independent) - 1
    following = SparseMatrix.from_triplets(
        (size, len(kept)),
        np.concatenate([kept, *rows]),
        np.concatenate([np.arange(len(kept)), *(place[some] for some in columns)]),
        np.concatenate([np.ones(len(kept)), *weights]),
    )
    return Freedom(freedom.free[kept], freedom.expansion.times(following))


def _equilibrium(
    group: IndexArray, motions: SparseMatrix, balance: SparseMatrix, diagonal: FloatArray
) -> _Sums:
    """Return the dofs that a group of motions solves for, and what makes them from others."""
    moved, _ = motions.dense_columns(group)
    dofs, forces = balance.dense_columns(group)
    own = np.isin(dofs, moved)
    scaled = forces / np.sqrt(diagonal[dofs])[:, np.newaxis]
    pivots = np.flatnonzero(own)
    if len(pivots) > len(group):
        pivots = pivots[independent_rows(scaled[own] / np.abs(scaled[own]).max(axis=0))]
    rest = np.ones(len(dofs), dtype=bool)
    rest[pivots] = False
    sums = np.linalg.solve(forces[pivots].T, forces[rest].T)
    return dofs[pivots], dofs[rest], -np.array(sums)


def _groups(motions: SparseMatrix, balance: SparseMatrix) -> list[IndexArray]:
    """Return the massless motions whose equilibrium must be solved for together."""
    dofs, number = motions.shape
    moved = np.zeros(dofs, dtype=bool)
    moved[motions.rows] = True
    coupling = balance.where(moved[balance.rows])
    vertices = components(number + dofs, coupling.columns, number + coupling.rows)
    groups = [np.array([vertex for vertex in some if vertex < number]) for some in vertices]
    largest = max(map(len, groups))
    if largest > MOST_CONDENSED:
        what = f"{largest} motions without mass hang together, more than {MOST_CONDENSED}"
        raise InputError(what, hint="give their nodes mass and rotary inertia")
    return [group for group in groups if len(group)]


def _null_motions(matrix: SparseMatrix) -> SparseMatrix:
    """Return a basis of what a symmetric matrix without negative eigenvalues takes to zero."""
    size = matrix.shape[0]
    empty = np.flatnonzero(np.diff(matrix.starts) == 0)
    number = len(empty)
    rows, columns, values = [empty], [np.arange(number)], [np.ones(number)]
    for group in components(size, matrix.rows, matrix.columns):
        if len(group) == 1:
            continue
        dofs = np.array(group)
        motions = _null_vectors(matrix.restricted(dofs).to_dense())
        row, column = np.nonzero(motions)
        rows.append(dofs[row])
        columns.append(number + column)
        values.append(motions[row, column])
        number += motions.shape[1]
    return SparseMatrix.from_triplets(
        (size, number), np.concatenate(rows), np.concatenate(columns), np.concatenate(values)
    )


def _null_vectors(matrix: FloatArray) -> FloatArray:
    """Return what a small matrix takes to zero, each vector of largest component one."""
    diagonal = np.abs(matrix.diagonal())
    scale = 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    motions = scale[:, np.newaxis] * null_space(matrix * np.outer(scale, scale))
    largest: FloatArray = np.abs(motions).max(axis=0, initial=0.0)
    return motions / largest
