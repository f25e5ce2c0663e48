from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from bumpstop.structure.sparse import SparseMatrix

Array = NDArray[np.float64]


@pytest.fixture
def triplets() -> tuple[NDArray[np.intp], NDArray[np.intp], Array]:
    """Repeated places, and rows and columns without entries."""
    random = np.random.default_rng(3)
    return random.integers(0, 6, 40), random.integers(1, 7, 40), random.normal(size=40)


def test_against_scipy(triplets: tuple[NDArray[np.intp], NDArray[np.intp], Array]) -> None:
    from scipy.sparse import coo_array

    rows, columns, values = triplets
    matrix = SparseMatrix.from_triplets((8, 9), rows, columns, values)
    expected = coo_array((values, (rows, columns)), shape=(8, 9)).toarray()
    np.testing.assert_allclose(matrix.to_dense(), expected, atol=1e-15)
    theirs = matrix.to_scipy()
    assert theirs.has_canonical_format
    np.testing.assert_array_equal(theirs.toarray(), matrix.to_dense())
    np.testing.assert_array_equal(matrix.diagonal(), np.diag(matrix.to_dense()))


def test_products(triplets: tuple[NDArray[np.intp], NDArray[np.intp], Array]) -> None:
    matrix = SparseMatrix.from_triplets((8, 9), *triplets)
    fields = np.random.default_rng(4).normal(size=(9, 3))
    np.testing.assert_allclose(matrix @ fields, matrix.to_dense() @ fields, atol=1e-14)
    np.testing.assert_allclose(matrix @ fields[:, 0], matrix.to_dense() @ fields[:, 0], atol=1e-14)


def test_a_part(triplets: tuple[NDArray[np.intp], NDArray[np.intp], Array]) -> None:
    matrix = SparseMatrix.from_triplets((9, 9), *triplets)
    kept = np.array([0, 2, 3, 6])
    expected = matrix.to_dense()[np.ix_(kept, kept)]
    np.testing.assert_array_equal(matrix.restricted(kept).to_dense(), expected)


def test_nothing_in_it() -> None:
    nothing = np.zeros(0, dtype=np.intp)
    empty = SparseMatrix.from_triplets((3, 3), nothing, nothing, np.zeros(0))
    np.testing.assert_array_equal(empty.to_dense(), np.zeros((3, 3)))
    np.testing.assert_array_equal(empty @ np.ones(3), np.zeros(3))
    assert empty.to_scipy().nnz == 0
