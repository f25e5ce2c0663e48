"""Modes of matrices with difficult spectra: equal, clustered, negative and distant ones."""

from __future__ import annotations

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse import coo_array, csc_array, diags_array

from bumpstop._core import CoreError, SparseFactor, assemble, sparse_modes, sturm_count
from bumpstop.modal.coupled import FEW, coupled_modes
from bumpstop.modal.selection import AllModes, LowestModes, ModesAround, ModesInBand
from bumpstop.structure.sparse import SparseMatrix

Array = NDArray[np.float64]

MANY = FEW + 100


def sparse(matrix: object) -> SparseMatrix:
    entries = coo_array(matrix)
    rows, columns = (np.asarray(place, dtype=np.intp) for place in entries.coords)
    return SparseMatrix.from_triplets(entries.shape, rows, columns, entries.data.astype(float))


def chain(size: int, spring: float = 1.0) -> csc_array:
    beside = -spring * np.ones(size - 1)
    return csc_array(
        diags_array([2.0 * spring * np.ones(size), beside, beside], offsets=[0, 1, -1])
    )


def modes(stiffness: object, mass: object, *, lowest: int) -> Array:
    matrix, size = sparse(stiffness), sparse(mass)
    return coupled_modes(matrix, size, np.zeros((size.shape[0], 0)), LowestModes(lowest)).omega2


def test_many_equal_oscillators_that_are_coupled() -> None:
    """Forty equal oscillators on a base that moves: 39 of them swing against each other."""
    stiffness = np.diag(np.concatenate([[1e4 + 40.0], np.ones(40), 50.0 + np.arange(MANY)]))
    stiffness[0, 1:41] = stiffness[1:41, 0] = -1.0
    mass = np.eye(len(stiffness))
    found = modes(stiffness, mass, lowest=41)
    np.testing.assert_allclose(found[:41], eigh(stiffness, eigvals_only=True)[:41], rtol=1e-12)
    assert np.count_nonzero(np.abs(found - 1.0) < 1e-12) == 39


def test_a_cluster_is_told_apart_as_far_as_it_can_be() -> None:
    omega2 = np.concatenate([1.0 + 1e-9 * np.arange(12), 5.0 + np.arange(MANY)])
    matrix, mass = sparse(np.diag(omega2)), sparse(np.eye(len(omega2)))
    found = coupled_modes(matrix, mass, np.zeros((len(omega2), 0)), LowestModes(5))
    np.testing.assert_allclose(found.omega2, omega2[:12], rtol=1e-13)
    unit = found.shapes.T @ found.shapes
    np.testing.assert_allclose(unit, np.eye(12), atol=1e-13)


def test_a_buckled_structure_has_negative_eigenvalues_first() -> None:
    stiffness = chain(MANY).toarray() - 0.03 * np.eye(MANY)
    expected = eigh(stiffness, eigvals_only=True)
    assert np.count_nonzero(expected < 0.0) > 10
    for lowest in (5, 50):
        found = modes(stiffness, np.eye(MANY), lowest=lowest)
        np.testing.assert_allclose(found[:lowest], expected[:lowest], atol=1e-13)


@pytest.mark.parametrize(
    ("stiff", "heavy"), [(1e-12, 1e-15), (1e15, 1e-9), (1e-9, 1e12), (1e20, 1)]
)
def test_any_units(stiff: float, heavy: float) -> None:
    mass = diags_array(heavy * (1.0 + np.arange(MANY) % 3))
    found = modes(chain(MANY, stiff), mass, lowest=20)
    unit = modes(chain(MANY), diags_array(1.0 + np.arange(MANY) % 3), lowest=20)
    np.testing.assert_allclose(found * (heavy / stiff), unit, rtol=1e-12)


def test_masses_of_many_sizes() -> None:
    mass = np.exp(np.linspace(-9.0, 9.0, MANY))
    stiffness = chain(MANY).toarray()
    expected = eigh(stiffness, np.diag(mass), eigvals_only=True)[:15]
    np.testing.assert_allclose(modes(stiffness, np.diag(mass), lowest=15), expected, rtol=1e-8)


def test_dofs_without_mass_follow_the_others() -> None:
    """Lumped masses on every third dof only: the others follow in equilibrium."""
    stiffness, mass = chain(MANY), np.zeros(MANY)
    mass[::3] = 2.0
    matrices = sparse(stiffness), sparse(diags_array(mass))
    omega2, shapes, _, (_, below) = sparse_modes(
        matrices[0].arrays, matrices[1].arrays, np.zeros((MANY, 0)), lowest=10
    )
    dense, moving = stiffness.toarray(), mass > 0.0
    inner = np.linalg.solve(dense[np.ix_(~moving, ~moving)], dense[np.ix_(~moving, moving)])
    condensed = dense[np.ix_(moving, moving)] - dense[np.ix_(moving, ~moving)] @ inner
    expected = eigh(condensed, 2.0 * np.eye(moving.sum()), eigvals_only=True)
    assert below == len(omega2)
    np.testing.assert_allclose(omega2[:10], expected[:10], rtol=1e-10)
    np.testing.assert_allclose(shapes[~moving], -inner @ shapes[moving], atol=1e-8)


def test_dense_and_sparse_agree_about_every_selection() -> None:
    stiffness, mass = sparse(chain(FEW)), sparse(diags_array(1.0 + np.arange(FEW) % 7))
    nothing = np.zeros((FEW, 0))
    matrices = stiffness.arrays, mass.arrays, nothing
    every = coupled_modes(stiffness, mass, nothing, AllModes()).omega2
    hertz = np.sqrt(every) / (2.0 * np.pi)
    band = ModesInBand(hertz[30], hertz[50])
    dense = coupled_modes(stiffness, mass, nothing, band).omega2
    found = sparse_modes(*matrices, band=(every[30], every[50]))[0]
    np.testing.assert_allclose(found, dense, rtol=1e-12)
    assert len(found) == 21
    around = coupled_modes(stiffness, mass, nothing, ModesAround(hertz[100], 7)).omega2
    found = sparse_modes(*matrices, around=(every[100], 7))[0]
    np.testing.assert_allclose(found, around, rtol=1e-12)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 30), st.integers(2, 60))
def test_random_matrices(seed: int, count: int, rank: int) -> None:
    """Random sparse matrices, definite or not, against LAPACK."""
    random = np.random.default_rng(seed)
    size = 90
    factor = random.normal(size=(size, rank)) * (random.random((size, rank)) < 0.1)
    stiffness = factor @ factor.T + np.diag(random.normal(size=size) + random.choice([0.0, 2.0]))
    mass = np.diag(random.uniform(0.1, 3.0, size))
    expected = eigh(stiffness, mass, eigvals_only=True)
    matrices = sparse(stiffness), sparse(mass)
    omega2, _, low, (high, below) = sparse_modes(
        matrices[0].arrays, matrices[1].arrays, np.zeros((size, 0)), lowest=count
    )
    assert low is None
    assert count <= below == len(omega2) == np.count_nonzero(expected < high)
    np.testing.assert_allclose(omega2, expected[:below], atol=1e-10 * np.abs(expected).max())
    point = random.choice(expected) + 1e-3
    at, below = sturm_count(matrices[0].arrays, matrices[1].arrays, [point])
    assert at == point
    assert below == np.count_nonzero(expected < point)


def test_a_factor_solves_and_counts() -> None:
    random = np.random.default_rng(1)
    stiffness = chain(200).toarray() - 0.5 * np.eye(200)
    loads = random.normal(size=(200, 3))
    factor = SparseFactor(sparse(stiffness).arrays)
    np.testing.assert_allclose(factor.solve(loads), np.linalg.solve(stiffness, loads), rtol=1e-9)
    assert factor.negative_pivots == np.count_nonzero(eigh(stiffness, eigvals_only=True) < 0.0)
    assert factor.singular_at is None


def test_a_singular_matrix_is_told_with_its_place() -> None:
    stiffness = chain(50).toarray()
    stiffness[0, 0] = stiffness[-1, -1] = 1.0
    loose = SparseFactor(sparse(stiffness).arrays)
    assert loose.singular_at is not None
    assert loose.weakest_pivot < 1e-13
    with pytest.raises(CoreError, match="singular at unknown"):
        loose.solve(np.ones((50, 1)))
    nothing = SparseFactor(sparse(np.diag([1.0, 0.0, 2.0])).arrays)
    assert nothing.singular_at == 1


@pytest.mark.parametrize(
    ("stiffness", "mass", "answer"),
    [
        ([[1.0, 2.0], [3.0, 1.0]], np.eye(2), "the stiffness matrix is not symmetric"),
        ([[1.0, 0.0], [5.0, 1.0]], np.eye(2), "its entries (1, 0) and (0, 1) differ"),
        ([[1.0, np.nan], [np.nan, 1.0]], np.eye(2), "holds a number that is not finite"),
        (np.eye(2), [[1.0, 0.0], [0.0, -1.0]], "the mass of dof 1 (counted from 0) is negative"),
        (np.eye(2), [[1.0, 3.0], [3.0, 1.0]], "some motion has a negative kinetic energy"),
        (np.eye(2), np.eye(3), "the sizes or places of stiffness and mass do not fit together"),
        (np.zeros((2, 2)), np.zeros((2, 2)), "singular"),
    ],
)
def test_matrices_that_cannot_be(stiffness: object, mass: object, answer: str) -> None:
    matrices = sparse(stiffness), sparse(mass)
    with pytest.raises(CoreError, match=re.escape(answer)):
        sparse_modes(matrices[0].arrays, matrices[1].arrays, np.zeros((2, 0)), lowest=1)


def test_triplets_outside_the_matrix() -> None:
    ones = np.ones(1, dtype=np.intp)
    with pytest.raises(CoreError, match="triplets"):
        assemble(ones, -ones, np.ones(1), (2, 2))
