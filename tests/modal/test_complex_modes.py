"""Complex modes and the Campbell diagram."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.linalg import eigvals

import bumpstop as bs
from bumpstop.modal import campbell, complex_modes

Array = NDArray[np.float64]

PLANE = [("P", "dx"), ("P", "dy")]
UPRIGHT = (0.0, 0.0, 1.0)


def point(**matrices: Any) -> bs.ModalBasis:
    """Return a mass of 2 kg on springs in a plane, its motion x + i y."""
    model = bs.Matrices(stiffness=50.0 * np.eye(2), mass=2.0 * np.eye(2), dofs=PLANE, **matrices)
    return bs.ModalBasis.from_structure(model, modes=2)


def roots(damping: complex, stiffness: complex) -> NDArray[np.complex128]:
    """Return the roots of z'' + damping z' + stiffness z = 0."""
    return np.roots([1.0, damping, stiffness]).astype(np.complex128)


@pytest.mark.parametrize("spin", [0.0, 0.3, 4.0, -4.0])
@pytest.mark.parametrize("damper", [0.0, 1.0])
def test_a_point_that_precesses(spin: float, damper: float) -> None:
    """M z'' + (c - i g) z' + k z = 0: one root turns forward and the other backward."""
    skew = np.array([[0.0, spin], [-spin, 0.0]])
    modes = complex_modes(point(gyroscopic=skew, damping=damper * np.eye(2)))
    wanted = roots((damper - 1j * spin) / 2.0, 25.0)
    wanted = wanted[np.argsort(np.abs(wanted.imag))]
    np.testing.assert_allclose(modes.eigenvalues.imag, np.abs(wanted.imag), rtol=1e-12)
    np.testing.assert_allclose(modes.eigenvalues.real, wanted.real, atol=1e-13)
    np.testing.assert_allclose(modes.frequencies, np.abs(wanted.imag) / (2 * math.pi))
    np.testing.assert_allclose(modes.damping_ratio, -wanted.real / np.abs(wanted), atol=1e-13)
    if spin:
        np.testing.assert_allclose(modes.whirl(UPRIGHT), np.sign(wanted.imag), atol=1e-12)
        np.testing.assert_allclose(modes.whirl((0, 0, -2)), -np.sign(wanted.imag), atol=1e-12)
        np.testing.assert_allclose(modes.whirl((1, 0, 0)), 0.0, atol=1e-12)


def test_skew_stiffness_makes_one_whirl_grow() -> None:
    """M z'' + c z' + (k - i n) z = 0."""
    skew = np.array([[0.0, 20.0], [-20.0, 0.0]])
    modes = complex_modes(point(circulatory=skew, damping=np.eye(2)))
    wanted = roots(0.5, 25.0 - 10.0j)
    forward = int(np.argmax(modes.whirl(UPRIGHT)))
    grows = wanted[wanted.imag > 0.0][0]
    assert grows.real > 0.0
    np.testing.assert_allclose(modes.eigenvalues[forward], grows, rtol=1e-12)
    assert modes.damping_ratio[forward] < 0.0 < modes.damping_ratio[1 - forward]


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_eigenvalues_are_those_of_the_whole_model(seed: int) -> None:
    rng = np.random.default_rng(seed)
    root, other, skew, around = rng.normal(size=(4, 4, 4))
    mass = np.eye(4) + 0.1 * np.diag(rng.uniform(size=4))
    stiffness = root @ root.T + np.eye(4)
    damping = 0.1 * other @ other.T
    gyroscopic, circulatory = skew - skew.T, 0.1 * (around - around.T)
    model = bs.Matrices(
        stiffness=stiffness,
        mass=mass,
        damping=damping,
        gyroscopic=gyroscopic,
        circulatory=circulatory,
        dofs=[*PLANE, ("Q", "dx"), ("Q", "dy")],
    )
    modes = complex_modes(bs.ModalBasis.from_structure(model, modes="all"))
    for eigenvalue, shape in zip(modes.eigenvalues, modes.shapes.T, strict=True):
        pencil = eigenvalue**2 * mass + eigenvalue * (damping + gyroscopic)
        residual = (pencil + stiffness + circulatory) @ shape
        assert np.abs(residual).max() < 1e-10 * np.abs(shape).max() * np.abs(pencil).max()
    nothing, one = np.zeros((4, 4)), np.eye(4)
    first = np.block([[nothing, one], [-(stiffness + circulatory), -(damping + gyroscopic)]])
    second = np.block([[one, nothing], [nothing, mass]])
    wanted = eigvals(first, second)
    wanted = wanted[wanted.imag >= -1e-12]
    assert len(modes.eigenvalues) == len(wanted)
    np.testing.assert_allclose(modes.frequencies * 2 * math.pi, np.sort(wanted.imag), atol=1e-9)


def test_without_damping_they_are_the_modes() -> None:
    model = bs.Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
        beams=[
            bs.Beam(
                "AB",
                nodes=("A", "B"),
                elements=5,
                material=bs.Material(young_modulus=67e9, poisson_ratio=0.3, density=2400.0),
                section=bs.Rectangle(height=0.01, width=0.02),
            )
        ],
    )
    basis = bs.ModalBasis.from_structure(model, modes=15)
    modes = complex_modes(basis)
    np.testing.assert_allclose(modes.frequencies, basis.frequencies, rtol=1e-12)
    np.testing.assert_array_equal(modes.eigenvalues[:6], 0.0)
    np.testing.assert_allclose(modes.damping_ratio, 0.0, atol=1e-12)
    for mode, vector in enumerate(modes.vectors.T[6:], start=6):
        assert abs(vector[mode]) == pytest.approx(1.0, rel=1e-9)


def test_motions_that_do_not_oscillate() -> None:
    model = bs.Matrices(
        stiffness=np.diag([0.0, 4.0, -9.0]),
        mass=np.eye(3),
        damping=np.diag([0.5, 5.0, 0.0]),
        dofs=[("P", "dx"), ("P", "dy"), ("P", "dz")],
    )
    basis = bs.ModalBasis(
        omega2=np.array([0.0, 4.0, -9.0]),
        damping_ratio=np.zeros(3),
        damping_matrix=np.diag([0.5, 5.0, 0.0]),
        dofs=model.dofs,
        shapes=np.eye(3),
    )
    modes = complex_modes(basis)
    np.testing.assert_allclose(modes.eigenvalues, [-4.0, -3.0, -1.0, -0.5, 3.0], atol=1e-14)
    np.testing.assert_array_equal(modes.damping_ratio, [1.0, 1.0, 1.0, 1.0, -1.0])


def shaft(spin: float) -> bs.Structure:
    return bs.Structure(
        nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
        beams=[
            bs.Beam(
                "AB",
                nodes=("A", "B"),
                elements=6,
                material=bs.Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0),
                section=bs.Circle(radius=0.05),
                spin=spin,
            )
        ],
        supports=[
            bs.Support(nodes="all", fixed=("dx", "drx")),
            bs.Support(nodes=("A", "B"), fixed=("dy", "dz")),
        ],
    )


def test_campbell_of_a_shaft() -> None:
    """Forward whirls rise and backward ones fall with the speed; none at rest."""
    basis = bs.ModalBasis.from_structure(shaft(1000.0), modes="all")
    speeds = [0.0, 2000.0, 5000.0]
    diagram = campbell(basis, speeds, spin=1000.0, count=4)
    assert diagram.frequencies.shape == (3, 4)
    rest = np.repeat(basis.frequencies[[0, 2]], 2)
    np.testing.assert_allclose(diagram.frequencies[0], rest, rtol=1e-9)
    np.testing.assert_allclose(np.abs(diagram.whirl[1:]), 1.0, atol=1e-9)
    np.testing.assert_allclose(diagram.whirl[1:], [[-1, 1, -1, 1]] * 2, atol=1e-9)
    assert np.all(np.diff(diagram.frequencies[:, 1::2], axis=0) > 0.0)
    assert np.all(np.diff(diagram.frequencies[:, 0::2], axis=0) < 0.0)
    np.testing.assert_allclose(diagram.damping_ratio, 0.0, atol=1e-10)
    made = campbell(
        lambda speed: bs.ModalBasis.from_structure(shaft(speed), modes="all"), speeds, count=4
    )
    np.testing.assert_allclose(made.frequencies, diagram.frequencies, rtol=1e-9)


def test_campbell_against_the_whole_matrices() -> None:
    model = shaft(5000.0)
    matrices = (model.mass, model.gyroscopic, model.stiffness)
    mass, gyroscopic, stiffness = (model.reduced(matrix).to_dense() for matrix in matrices)
    size = len(mass)
    nothing, one = np.zeros((size, size)), np.eye(size)
    wanted = eigvals(
        np.block([[nothing, one], [-stiffness, -gyroscopic]]),
        np.block([[one, nothing], [nothing, mass]]),
    )
    lowest = np.sort(wanted.imag[wanted.imag > 0.0])[:4] / (2 * math.pi)
    basis = bs.ModalBasis.from_structure(model, modes="all")
    found = campbell(basis, [5000.0], spin=5000.0, count=4)
    np.testing.assert_allclose(found.frequencies[0], lowest, rtol=1e-8)


def test_bad_input_is_refused() -> None:
    basis = point()
    with pytest.raises(bs.InputError, match="spin: must not be zero"):
        campbell(basis, [1.0], spin=0.0)
    with pytest.raises(bs.InputError, match="speeds: must be finite"):
        campbell(basis, [math.nan])
    with pytest.raises(bs.InputError, match="axis: must have a length"):
        complex_modes(basis).whirl((0, 0, 0))
