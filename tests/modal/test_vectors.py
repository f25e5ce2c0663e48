"""Bases of any vectors: the canonical form, and the way to and from it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.linalg import eigh

import bumpstop as bs

Array = NDArray[np.float64]

ALLOY = bs.Material(young_modulus=67e9, poisson_ratio=0.3, density=2400.0)
BAR = bs.Rectangle(height=0.014, width=0.02)
CLAMP = bs.Support(nodes="A", fixed=("dx", "dy", "dz", "drx", "dry", "drz"))
PLANE = bs.Support(nodes="all", fixed=("dx", "dz", "drx", "dry"))


def beam(*supports: bs.Support) -> bs.Structure:
    return bs.Structure(
        nodes={"A": (0, 0, 0), "B": (0.783, 0, 0)},
        beams=[bs.Beam("AB", nodes=("A", "B"), elements=6, material=ALLOY, section=BAR)],
        supports=supports,
    )


def random_vectors(model: bs.Structure, count: int, seed: int = 1) -> Array:
    free = np.random.default_rng(seed).normal(size=(len(model.free), count))
    return model.expansion @ free


def check_canonical(basis: bs.ModalBasis, vectors: Array) -> None:
    """Unit mass, diagonal stiffness, and coordinates that give the same displacements."""
    model = basis.model
    assert model is not None
    mass = basis.shapes.T @ (model.mass @ basis.shapes)
    np.testing.assert_allclose(mass, np.eye(len(mass)), atol=1e-11)
    stiffness = basis.shapes.T @ (model.stiffness @ basis.shapes)
    rounding = 1e-14 * np.abs(model.stiffness.values).max() * np.abs(basis.shapes).max() ** 2
    allowed = 1e-11 * np.abs(basis.omega2).max() + rounding
    np.testing.assert_allclose(stiffness, np.diag(basis.omega2), atol=allowed)
    amplitudes = np.random.default_rng(3).normal(size=(vectors.shape[1],))
    displacements = vectors @ amplitudes
    canonical = basis.canonical(amplitudes)
    size = np.abs(displacements).max()
    np.testing.assert_allclose(basis.shapes @ canonical, displacements, atol=1e-11 * size)
    again = vectors @ basis.amplitudes(canonical)
    np.testing.assert_allclose(again, displacements, atol=1e-11 * size)


def test_ritz_values_are_those_of_the_reduced_matrices() -> None:
    model = beam(CLAMP)
    vectors = random_vectors(model, 7)
    basis = bs.ModalBasis.from_vectors(model, vectors, damping=0.02)
    reduced = (vectors.T @ (matrix @ vectors) for matrix in (model.stiffness, model.mass))
    np.testing.assert_allclose(basis.omega2, eigh(*reduced, eigvals_only=True), rtol=1e-10)
    check_canonical(basis, vectors)
    assert basis.dropped == ()
    assert basis.labels[-1] == "vector 7"
    np.testing.assert_array_equal(basis.damping_ratio, 0.02)


def test_vectors_in_canonical_form_are_left_as_they_are() -> None:
    modes = bs.ModalBasis.from_structure(beam(PLANE), modes=8)
    assert modes.structure is not None
    mixed = modes.shapes[:, [3, 0, 1, 5, 2]]
    basis = bs.ModalBasis.from_vectors(modes.structure, mixed)
    np.testing.assert_array_equal(basis.shapes, mixed)
    assert basis.coordinates is None
    np.testing.assert_array_equal(basis.omega2[[1, 2]], 0.0)
    np.testing.assert_allclose(basis.omega2, modes.omega2[[3, 0, 1, 5, 2]], rtol=1e-10)


def test_modes_of_another_scale_are_only_scaled() -> None:
    modes = bs.ModalBasis.from_structure(beam(CLAMP), modes=3)
    assert modes.structure is not None
    vectors = modes.shapes * [2.0, 0.5, -4.0]
    basis = bs.ModalBasis.from_vectors(modes.structure, vectors)
    np.testing.assert_allclose(basis.shapes, modes.shapes * [1.0, 1.0, -1.0], rtol=1e-12)
    check_canonical(basis, vectors)


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 6), st.integers(0, 3))
def test_rigid_motions_are_found_in_any_mixture(seed: int, rigid: int, flexible: int) -> None:
    model = beam()
    still = model.expansion @ model.rigid_shapes()[:, :rigid]
    rng = np.random.default_rng(seed)
    vectors = np.hstack([still, random_vectors(model, flexible, seed)])
    mixture = rng.normal(size=(rigid + flexible, rigid + flexible)) + 3 * np.eye(rigid + flexible)
    basis = bs.ModalBasis.from_vectors(model, vectors @ mixture)
    assert np.count_nonzero(basis.omega2 == 0.0) == rigid
    assert np.all(basis.omega2[rigid:] > 0.0)
    strained = model.stiffness @ basis.shapes[:, :rigid]
    assert np.abs(strained).max() <= 1e-13 * np.abs(model.stiffness.values).max() * 10
    check_canonical(basis, vectors @ mixture)


def test_all_rigid_motions_come_out_as_plain_ones() -> None:
    model = beam(PLANE)
    still = model.expansion @ model.rigid_shapes()
    turned = np.hstack([still @ [[1.0, 2.0], [-1.0, 0.5]], random_vectors(model, 2)])
    basis = bs.ModalBasis.from_vectors(model, turned)
    heave = basis.shapes[[model.dofs.index((node, "dy")) for node in ("A", "B", "AB.1")], 0]
    assert np.ptp(heave) == 0.0


def test_dependent_vectors_are_dropped_with_a_word() -> None:
    model = beam(CLAMP)
    vectors = random_vectors(model, 4)
    vectors = np.insert(vectors, 2, vectors[:, 0] - 3 * vectors[:, 1], axis=1)
    vectors = np.insert(vectors, 5, 0.0, axis=1)
    basis = bs.ModalBasis.from_vectors(model, vectors, labels=list("abcdef"))
    assert len(basis.omega2) == 4
    assert basis.dropped == (
        "c is left out: it depends on those before it",
        "f is left out: it moves no mass",
    )
    assert basis.remarks == basis.dropped
    check_canonical(basis, vectors)
    np.testing.assert_array_equal(basis.amplitudes(np.ones(4))[[2, 5]], 0.0)


def test_unstable_vectors_are_allowed_and_told() -> None:
    basis = bs.ModalBasis.from_structure(beam(CLAMP), modes=2)
    unstable = bs.ModalBasis(
        omega2=np.array([-4.0, 9.0]),
        damping_ratio=np.zeros(2),
        dofs=basis.dofs,
        shapes=basis.shapes,
    )
    assert unstable.remarks == ("the structure is unstable in mode 1: it moves away by itself",)
    np.testing.assert_allclose(unstable.frequencies, [-2 / (2 * np.pi), 3 / (2 * np.pi)])
    np.testing.assert_array_equal(unstable.damping, 0.0)


def test_state_and_response_speak_of_the_vectors_given() -> None:
    """Vectors that are sums and differences of modes: their amplitudes are known."""
    modes = bs.ModalBasis.from_structure(beam(CLAMP), modes=2)
    model = modes.structure
    assert model is not None
    mixture = np.array([[1.0, 1.0], [1.0, -1.0]])
    basis = bs.ModalBasis.from_vectors(model, modes.shapes @ mixture, labels=["sum", "difference"])
    state = bs.ModalState(displacement=[1e-3, 2e-3], velocity=[0.1, 0.0])
    response = bs.simulate(bs.Problem(basis, initial=state, duration=0.01))
    times = response.times
    w = np.sqrt(modes.omega2)
    q = [3e-3, -1e-3] * np.cos(np.outer(times, w)) + [0.1, 0.1] / w * np.sin(np.outer(times, w))
    wanted = q @ np.linalg.inv(mixture).T
    np.testing.assert_allclose(response.sample("modal_displacement"), wanted, atol=1e-13)
    np.testing.assert_allclose(response.sample("modal_displacement", 2), wanted[:, 1], atol=1e-13)
    tip = response.sample("displacement", "B", "dy")
    np.testing.assert_allclose(tip, q @ modes.row("B", "dy"), atol=1e-13)
    labelled = response.modal_displacement()
    assert labelled.label.values.tolist() == ["sum", "difference"]
    assert "frequency" not in labelled.coords
    assert "units" not in labelled.attrs
    with pytest.raises(
        bs.InputError, match=r"for each of the 2 vectors .*they are sum, difference"
    ):
        bs.Problem(basis, initial=bs.ModalState(velocity=[1.0]), duration=1.0)


@pytest.mark.parametrize(
    ("vectors", "says"),
    [
        (np.zeros((42, 2)), "vectors: no vector moves any mass"),
        (np.zeros((41, 2)), "one row for each of the 42 dofs .*got '41 x 2'"),
        (np.zeros(42), "one row for each of the 42 dofs"),
        (np.zeros((42, 0)), "one row for each of the 42 dofs"),
        (np.full((42, 1), math.nan), "vectors: must be finite"),
        (np.ones((42, 1)), "vector 1 moves dx of A, which is not free"),
        ("modes", "vectors: must be numbers"),
    ],
)
def test_bad_vectors_are_refused(vectors: Any, says: str) -> None:
    with pytest.raises(bs.InputError, match=says):
        bs.ModalBasis.from_vectors(beam(CLAMP), vectors)


def test_labels_must_be_one_a_vector() -> None:
    model = beam(CLAMP)
    with pytest.raises(bs.InputError, match="labels: must be one for each of the 3 vectors"):
        bs.ModalBasis.from_vectors(model, random_vectors(model, 3), labels=["one"])
