from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from bumpstop.structure.elimination import Freedom, freedom
from bumpstop.structure.forms import LinearForm

Array = NDArray[np.float64]

SIZE = 9


def forms(matrix: Array) -> list[LinearForm]:
    rows = [np.flatnonzero(row) for row in matrix]
    return [
        LinearForm(dofs, row[dofs]) for dofs, row in zip(rows, matrix, strict=True) if len(dofs)
    ]


def told(matrix: Array, held: tuple[int, ...] = ()) -> Freedom:
    mask = np.zeros(matrix.shape[1], dtype=bool)
    mask[list(held)] = True
    return freedom(mask, forms(matrix), np.ones(matrix.shape[1]))


def check(matrix: Array, held: tuple[int, ...]) -> None:
    """The expansion spans the null space of supports and relations, found by SVD."""
    found = told(matrix, held)
    expansion = found.expansion.to_dense()
    constraints = np.vstack([matrix, np.eye(matrix.shape[1])[list(held)]])
    rank = np.linalg.matrix_rank(constraints)
    assert expansion.shape == (matrix.shape[1], matrix.shape[1] - rank)
    size = np.abs(expansion).max(initial=1.0)
    np.testing.assert_allclose(constraints @ expansion, 0.0, atol=1e-11 * size)
    np.testing.assert_array_equal(expansion[found.free], np.eye(len(found.free)))
    assert np.all(np.diff(found.free) > 0)


weights = st.sampled_from([0.0, 0.0, 0.0, 1.0, -1.0, 2.0, 0.5, -0.3, 7.0])


@settings(max_examples=150, derandomize=True, deadline=None)
@given(
    rows=st.lists(st.lists(weights, min_size=SIZE, max_size=SIZE), max_size=7),
    held=st.sets(st.integers(0, SIZE - 1), max_size=3),
    repeated=st.lists(st.lists(st.integers(-2, 2), min_size=7, max_size=7), max_size=3),
)
def test_any_relations(rows: list[list[float]], held: set[int], repeated: list[list[int]]) -> None:
    """Chains, loops, and relations that follow from others."""
    matrix = np.array(rows, dtype=float).reshape(-1, SIZE)
    follow = np.array(repeated, dtype=float).reshape(-1, 7)[:, : len(matrix)] @ matrix
    check(np.vstack([matrix, follow]), tuple(held))


def test_the_first_dof_of_a_relation_follows() -> None:
    found = told(np.array([[0.0, 2.0, 1.0, 0.0]]))
    assert found.free.tolist() == [0, 2, 3]
    np.testing.assert_array_equal(found.expansion.to_dense()[1], [0.0, -0.5, 0.0])


def test_a_dof_of_small_weight_does_not_follow() -> None:
    found = told(np.array([[1e-6, 2.0, 1.0]]))
    assert found.free.tolist() == [0, 2]


def test_weights_count_by_what_they_move() -> None:
    """A rotation that moves the node by 1000 mm a radian is the one to solve for."""
    row = LinearForm(np.array([0, 1, 2]), np.array([1e-5, 1.0, 1.0]))
    found = freedom(np.zeros(3, dtype=bool), [row], np.array([1.0, 1e-3, 1.0]))
    assert found.free.tolist() == [0, 1]


def test_a_loop_of_equal_motions_says_nothing_twice() -> None:
    loop = np.array([[1.0, -1.0, 0.0], [0.0, 1.0, -1.0], [-1.0, 0.0, 1.0]])
    np.testing.assert_array_equal(told(loop).expansion.to_dense(), np.ones((3, 1)))


def test_relations_may_fix_everything() -> None:
    found = told(np.array([[1.0, 1.0], [1.0, -1.0]]))
    assert found.free.tolist() == []
    assert found.expansion.shape == (2, 0)


def test_a_relation_of_held_dofs_says_nothing() -> None:
    assert told(np.array([[1.0, -1.0, 0.0]]), held=(0, 1)).free.tolist() == [2]


def test_a_support_of_one_dof_holds_the_other() -> None:
    assert told(np.array([[1.0, -1.0, 0.0]]), held=(1,)).free.tolist() == [2]


@pytest.mark.parametrize("length", [1, 50])
def test_a_chain_is_followed_to_its_end(length: int) -> None:
    """u0 = 2 u1, u1 = 2 u2, and so on: powers of two, to the bit."""
    chain = np.eye(length + 1)[:-1] - 2.0 * np.eye(length + 1)[1:]
    expansion = told(chain).expansion.to_dense()[:, 0]
    np.testing.assert_array_equal(expansion, 2.0 ** np.arange(length, -1, -1))
