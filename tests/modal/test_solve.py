"""Static solutions against dense ones."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import ArrayLike

from bumpstop import ComputationError
from bumpstop.modal.solve import StaticSolver
from bumpstop.structure.sparse import SparseMatrix


def sparse(matrix: ArrayLike) -> SparseMatrix:
    dense = np.array(matrix, dtype=float)
    rows, columns = np.nonzero(dense)
    return SparseMatrix.from_triplets(dense.shape, rows, columns, dense[rows, columns])


def test_several_loads_at_once() -> None:
    rng = np.random.default_rng(2)
    root = rng.normal(size=(7, 7))
    matrix, loads = root @ root.T + np.eye(7), rng.normal(size=(7, 3))
    solution = StaticSolver(sparse(matrix)).solve(loads)
    np.testing.assert_allclose(solution, np.linalg.solve(matrix, loads), rtol=1e-11)


def test_an_indefinite_matrix() -> None:
    matrix = np.array([[1.0, 3.0], [3.0, 1.0]])
    solution = StaticSolver(sparse(matrix)).solve(np.eye(2))
    np.testing.assert_allclose(solution, np.linalg.inv(matrix), rtol=1e-14)


def test_a_free_body_is_held_where_its_rigid_motions_ask() -> None:
    matrix = [[2.0, -2.0, 0.0], [-2.0, 5.0, -3.0], [0.0, -3.0, 3.0]]
    load = np.array([[1.0], [-3.0], [2.0]])
    solution = StaticSolver(sparse(matrix), np.ones((3, 1))).solve(load)
    np.testing.assert_allclose(matrix @ solution, load, atol=1e-14)
    assert np.count_nonzero(solution == 0.0) == 1


def test_nothing_but_rigid_motions() -> None:
    solver = StaticSolver(sparse([[0.0]]), np.ones((1, 1)))
    np.testing.assert_array_equal(solver.solve(np.zeros((1, 2))), 0.0)


def test_a_singular_matrix_is_refused() -> None:
    with pytest.raises(ComputationError, match="the stiffness matrix is singular"):
        StaticSolver(sparse([[1.0, -1.0], [-1.0, 1.0]]))


def test_nothing_moves_where_rigid_motions_are_all_there_is() -> None:
    """What is left to solve is a matrix without unknowns."""
    still = StaticSolver(sparse([[0.0]]), np.ones((1, 1)))
    np.testing.assert_array_equal(still.solve(np.zeros((1, 2))), np.zeros((1, 2)))
