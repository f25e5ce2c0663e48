from __future__ import annotations

import numpy as np
import pytest

from bumpstop.structure.echelon import independent_columns, null_space
from bumpstop.structure.graph import components


@pytest.mark.parametrize(("rows", "rank"), [(3, 3), (10, 2), (6, 6), (0, 0), (4, 0)])
def test_null_space(rows: int, rank: int) -> None:
    random = np.random.default_rng(rows)
    matrix = random.normal(size=(rows, rank)) @ random.normal(size=(rank, 6))
    basis = null_space(matrix)
    assert basis.shape == (6, 6 - rank)
    assert np.linalg.matrix_rank(basis) == 6 - rank
    np.testing.assert_allclose(matrix @ basis, 0.0, atol=1e-13)


def test_unit_vectors_stay_unit_vectors() -> None:
    held = np.eye(6)[[2, 3, 4]] + 1e-17
    np.testing.assert_allclose(null_space(held), np.eye(6)[:, [0, 1, 5]], atol=1e-16)


def test_rounding_counts_for_nothing() -> None:
    matrix = np.array([[1.0, 2.0, 0.0], [2.0, 4.0, 1e-15]])
    np.testing.assert_array_equal(independent_columns(matrix), matrix[:, [1]])
    assert independent_columns(np.full((3, 2), 1e-14)).shape == (3, 0)


def test_components() -> None:
    rows, columns = np.array([5, 1, 3, 2]), np.array([1, 3, 3, 4])
    found = [group.tolist() for group in components(6, rows, columns)]
    assert found == [[0], [1, 3, 5], [2, 4]]
    assert components(0, rows[:0], columns[:0]) == []
