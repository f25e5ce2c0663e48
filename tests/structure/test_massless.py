"""Motions without inertia, against pencils of dense matrices."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from bumpstop.errors import InputError
from bumpstop.structure.elimination import Freedom
from bumpstop.structure.forms import LinearForm
from bumpstop.structure.mobility import Mobility, mobility
from bumpstop.structure.sparse import SparseMatrix

Array = NDArray[np.float64]


def sparse(dense: Array) -> SparseMatrix:
    rows, columns = np.nonzero(dense)
    return SparseMatrix.from_triplets(dense.shape, rows, columns, dense[rows, columns])


def moving(stiffness: Array, mass: Array, **more: Array) -> Mobility:
    size = len(mass)
    matrices = {kind: np.zeros((size, size)) for kind in ("damping", "gyroscopic", "circulatory")}
    matrices |= {"stiffness": stiffness, "mass": mass} | more
    return mobility(
        tuple(("P", f"d{i}") for i in range(size)),
        Freedom(np.arange(size), SparseMatrix.selection(size, np.arange(size))),
        np.ones(size),
        np.zeros(size, dtype=bool),
        {kind: sparse(matrix) for kind, matrix in matrices.items()},
    )


def eigenvalues(stiffness: Array, mass: Array) -> Array:
    """Return the finite eigenvalues of a pencil: those of inverse mass that are not zero."""
    compliance = np.linalg.solve(stiffness, mass)
    inverse = np.sort(scipy.linalg.eigvals(compliance).real)[::-1]
    return 1.0 / inverse[: np.linalg.matrix_rank(mass, hermitian=True)]


def check(stiffness: Array, mass: Array) -> None:
    freedom = moving(stiffness, mass).freedom
    expansion = freedom.expansion.to_dense()
    np.testing.assert_array_equal(expansion[freedom.free], np.eye(len(freedom.free)))
    assert len(freedom.free) == np.linalg.matrix_rank(mass, hermitian=True)
    own_stiffness, own_mass = (
        freedom.reduced(sparse(matrix)).to_dense() for matrix in (stiffness, mass)
    )
    found = scipy.linalg.eigh(own_stiffness, own_mass, eigvals_only=True)
    np.testing.assert_allclose(found, eigenvalues(stiffness, mass), rtol=1e-7)


def test_a_mass_behind_two_springs_in_series() -> None:
    """The node between has no mass: 1/k = 1/k1 + 1/k2."""
    stiffness = np.array([[300.0 + 600.0, -600.0], [-600.0, 600.0]])
    mass = np.diag([0.0, 2.0])
    freedom = moving(stiffness, mass).freedom
    assert freedom.free.tolist() == [1]
    np.testing.assert_allclose(freedom.expansion.to_dense(), [[2.0 / 3.0], [1.0]], rtol=1e-15)
    assert freedom.reduced(sparse(stiffness)).to_dense() == pytest.approx(200.0)


def test_dofs_that_nothing_touches_are_left_out() -> None:
    stiffness, mass = np.diag([0.0, 5.0, 0.0, 0.0]), np.diag([0.0, 1.0, 2.0, 0.0])
    found = moving(stiffness, mass)
    assert found.freedom.free.tolist() == [1, 2]
    np.testing.assert_array_equal(found.massless.to_dense(), np.eye(4)[:, [0, 3]])


def test_a_slanting_motion_that_nothing_resists_is_left_out() -> None:
    """A massless joint of two slanting springs in line can move across them."""
    along = np.array([0.6, 0.8])
    spring = np.outer(along, along) * 1e3
    stiffness = np.zeros((4, 4))
    stiffness[:2, :2] = 2.0 * spring
    stiffness[2:, 2:] = spring
    stiffness[:2, 2:] = stiffness[2:, :2] = -spring
    mass = np.diag([0.0, 0.0, 1.0, 1.0])
    found = moving(stiffness, mass)
    assert len(found.freedom.free) == 2
    assert set(found.freedom.free) == {2, 3}
    joint = found.freedom.expansion.to_dense()[:2]
    np.testing.assert_allclose(joint.T @ along, 0.5 * along, rtol=1e-14)
    np.testing.assert_allclose(joint.T @ [-0.8, 0.6], 0.0, atol=1e-15)


def test_the_lever_of_one_mass() -> None:
    """A mass at the middle of a bar whose ends are on springs: the ends share its weight."""
    mass = 3.0 * np.outer([0.5, 0.5], [0.5, 0.5])
    stiffness = np.diag([100.0, 300.0])
    check(stiffness, mass)
    freedom = moving(stiffness, mass).freedom
    value = float(freedom.reduced(sparse(stiffness)).to_dense()[0, 0])
    inertia = float(freedom.reduced(sparse(mass)).to_dense()[0, 0])
    softness = 0.25 * (1 / 100.0 + 1 / 300.0)
    assert value / inertia == pytest.approx(1.0 / (3.0 * softness), rel=1e-14)


def test_a_massless_end_that_no_spring_holds_follows_freely() -> None:
    """One end of that bar without spring: the other one cannot carry the mass alone."""
    mass = np.outer([0.5, 0.5], [0.5, 0.5])
    freedom = moving(np.diag([100.0, 0.0]), mass).freedom
    assert freedom.reduced(sparse(np.diag([100.0, 0.0]))).to_dense() == pytest.approx(0.0)


@settings(max_examples=100, derandomize=True, deadline=None)
@given(
    size=st.integers(2, 7),
    rank=st.integers(1, 6),
    aligned=st.booleans(),
    density=st.sampled_from([0.3, 1.0]),
    seed=st.integers(0, 10_000),
)
def test_condensation_keeps_every_finite_frequency(
    size: int, rank: int, aligned: bool, density: float, seed: int
) -> None:
    random = np.random.default_rng(seed)
    rank = min(rank, size)
    if aligned:
        mass = np.diag(np.r_[random.uniform(0.5, 2.0, rank), np.zeros(size - rank)])
        order = random.permutation(size)
        mass = mass[np.ix_(order, order)]
    else:
        factor = random.normal(size=(size, rank)) * (random.random((size, rank)) < density)
        mass = factor @ factor.T
    if not mass.any():
        return
    factor = random.normal(size=(size, size)) * (random.random((size, size)) < density)
    check(factor @ factor.T + np.diag(random.uniform(0.5, 2.0, size)), mass)


def test_a_force_is_refused_where_it_finds_no_mass() -> None:
    stiffness = np.array([[900.0, -600.0, 0.0], [-600.0, 600.0, 0.0], [0.0, 0.0, 0.0]])
    found = moving(stiffness, np.diag([0.0, 2.0, 0.0]))

    def on(*weights: float) -> LinearForm:
        return LinearForm(np.arange(3), np.array(weights))

    assert found.has_inertia(on(0.0, 1.0, 0.0))
    assert not found.has_inertia(on(1.0, 0.0, 0.0))
    assert not found.has_inertia(on(0.0, 1.0, 1.0))


@pytest.mark.parametrize("kind", ["damping", "gyroscopic", "circulatory"])
def test_what_would_follow_late_is_refused(kind: str) -> None:
    """A spring and a damper in series have a state of their own."""
    matrix = np.array([[0.0, 1.0], [-1.0, 0.0]]) if kind != "damping" else np.diag([1.0, 0.0])
    with pytest.raises(InputError, match=r"nodes.P: d0 is moved by .* but has no mass"):
        moving(np.eye(2), np.diag([0.0, 1.0]), **{kind: matrix})


@pytest.mark.parametrize(
    "stiffness",
    [
        np.diag([5.0, -1.0]),
        np.array([[5.0, 2.0], [2.0, 0.0]]),  # no work on it alone, but pushed by the other
    ],
)
def test_what_is_pushed_away_without_inertia_is_refused(stiffness: Array) -> None:
    with pytest.raises(InputError, match=r"nodes.P: d1 is pushed away by a negative stiffness"):
        moving(stiffness, np.diag([1.0, 0.0]))


def test_two_motions_that_are_pushed_away_together() -> None:
    stiffness = np.array([[9.0, 0.0, 0.0], [0.0, 1.0, 2.0], [0.0, 2.0, 1.0]])
    with pytest.raises(InputError, match=r"nodes.P: d. is pushed away by a negative stiffness"):
        moving(stiffness, np.diag([1.0, 0.0, 0.0]))


def test_nothing_with_mass() -> None:
    with pytest.raises(InputError, match="nothing that can move has mass"):
        moving(np.eye(3), np.zeros((3, 3)))
