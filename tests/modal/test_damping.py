"""Damping of the modes, from rules, dampers and what couples the modes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.linalg import eigh

import bumpstop as bs

Array = NDArray[np.float64]

STIFFNESS = np.array([[5e4, -2e4, 0.0], [-2e4, 4e4, -2e4], [0.0, -2e4, 2e4]])
MASS = np.diag([2.0, 1.0, 3.0])
DOFS = [(node, "dx") for node in "PQR"]


def chain(**matrices: Any) -> bs.Matrices:
    return bs.Matrices(stiffness=STIFFNESS, mass=MASS, dofs=DOFS, **matrices)


@given(st.floats(1e-9, 10), st.floats(1e-9, 1e-3))
def test_rayleigh_damping_is_that_of_its_matrix(alpha: float, beta: float) -> None:
    """By rule or as a matrix of the model: the same damping, without coupling."""
    by_rule = bs.ModalBasis.from_structure(
        chain(), modes=3, damping=bs.RayleighDamping(alpha=alpha, beta=beta)
    )
    by_matrix = bs.ModalBasis.from_structure(
        chain(damping=alpha * MASS + beta * STIFFNESS), modes=3
    )
    np.testing.assert_allclose(
        by_rule.damping, alpha + beta * by_rule.omega2, rtol=1e-12, atol=1e-300
    )
    np.testing.assert_allclose(by_matrix.damping, by_rule.damping, rtol=1e-10, atol=1e-12)
    np.testing.assert_allclose(by_matrix.damping_ratio, by_rule.damping_ratio, rtol=1e-9)
    if by_matrix.damping_matrix is not None:
        beside = by_matrix.damping_matrix - np.diag(by_matrix.damping_matrix.diagonal())
        assert not beside.any()


def test_rayleigh_damping_through_two_points() -> None:
    rule = bs.RayleighDamping.from_ratios(frequencies=[20.0, 5.0], ratios=[0.03, 0.01])
    w = 2 * math.pi * np.array([20.0, 5.0])
    np.testing.assert_allclose(rule.modal(w**2) / (2 * w), [0.03, 0.01], rtol=1e-13)


def test_damping_that_feeds_energy_is_told() -> None:
    basis = bs.ModalBasis.from_structure(chain(damping=-0.1 * MASS), modes=3)
    assert basis.remarks == ("negative damping feeds energy into the modes",)
    assert bs.ModalBasis.from_structure(chain(damping=0.1 * MASS), modes=3).remarks == ()


def test_an_unstable_stiffness_is_told_in_one_line() -> None:
    model = bs.Matrices(stiffness=-STIFFNESS, mass=MASS, dofs=DOFS)
    (line,) = bs.ModalBasis.from_structure(model, modes=3).remarks
    assert line.startswith("the structure is unstable in all its 3 modes: is the sign of the stif")
    saddle = bs.Matrices(stiffness=np.diag([-2.0, -1.0, 3.0]), mass=MASS, dofs=DOFS)
    (line,) = bs.ModalBasis.from_structure(saddle, modes=3).remarks
    assert line == "the structure is unstable in modes 1 to 2: it moves away by itself"


def test_rayleigh_damping_slows_rigid_modes() -> None:
    pair = bs.Matrices(
        stiffness=[[1e4, -1e4], [-1e4, 1e4]],
        mass=[[2.0, 0.0], [0.0, 3.0]],
        dofs=[("P", "dx"), ("Q", "dx")],
    )
    basis = bs.ModalBasis.from_structure(pair, modes=2, damping=bs.RayleighDamping(alpha=0.5))
    np.testing.assert_array_equal(basis.damping, 0.5)
    drift = bs.Problem(basis, initial=bs.ModalState(velocity=[1.0, 0.0]), duration=4.0, sample=1.0)
    speed = bs.simulate(drift).sample("modal_velocity", 1)
    np.testing.assert_allclose(speed, np.exp(-0.5 * np.arange(5)), rtol=1e-12)


def test_structural_damping_is_half_the_loss_factor() -> None:
    basis = bs.ModalBasis.from_structure(chain(), modes=3, damping=bs.StructuralDamping(0.03))
    np.testing.assert_allclose(basis.damping_ratio, 0.015, rtol=1e-14)
    assert basis.damping_matrix is None


def test_dampers_add_to_the_ratios() -> None:
    damper = np.zeros((3, 3))
    damper[2, 2] = 7.0
    _, modes = eigh(STIFFNESS, MASS)
    wanted = modes.T @ damper @ modes
    basis = bs.ModalBasis.from_structure(chain(damping=damper), modes=3, damping=0.01)
    assert basis.damping_matrix is not None
    wanted = np.abs(wanted) + np.diag(0.02 * np.sqrt(basis.omega2))
    np.testing.assert_allclose(np.abs(basis.damping_matrix), wanted, rtol=1e-9)
    np.testing.assert_array_equal(basis.damping_matrix, basis.damping_matrix.T)
    np.testing.assert_allclose(
        basis.damping_ratio, wanted.diagonal() / (2 * np.sqrt(basis.omega2)), rtol=1e-9
    )


def test_coupling_is_neglected_on_request() -> None:
    damper = np.zeros((3, 3))
    damper[2, 2] = 7.0
    coupled = bs.ModalBasis.from_structure(chain(damping=damper), modes=3)
    alone = bs.ModalBasis.from_structure(
        chain(damping=damper), modes=3, damping_coupling="diagonal"
    )
    assert coupled.couples
    assert not alone.couples
    np.testing.assert_array_equal(alone.damping, coupled.damping)
    (remark,) = alone.remarks
    # A single damper couples every pair of modes as much as it damps them.
    assert remark.startswith("damping that couples modes is neglected, at most 100 % of")
    assert bs.simulate(bs.Problem(alone, duration=0.1)).energy_residual < 1e-12
    with pytest.raises(bs.InputError, match="unknown damping_coupling"):
        bs.ModalBasis.from_structure(chain(), modes=3, damping_coupling="none")


@pytest.mark.parametrize("kind", ["gyroscopic", "circulatory"])
def test_skew_matrices_are_projected(kind: str) -> None:
    skew = np.array([[0.0, 3.0, 0.0], [-3.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    basis = bs.ModalBasis.from_structure(chain(**{kind: skew}), modes=3)
    matrix = getattr(basis, kind)
    np.testing.assert_array_equal(matrix, -matrix.T)
    np.testing.assert_allclose(matrix, basis.shapes.T @ skew @ basis.shapes, atol=1e-14)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: bs.RayleighDamping(alpha=-1.0), "alpha: must not be negative"),
        (lambda: bs.RayleighDamping(beta=math.nan), "beta: must be finite"),
        (lambda: bs.StructuralDamping(-0.1), "loss_factor: must not be negative"),
        (
            lambda: bs.RayleighDamping.from_ratios(frequencies=[1, 10], ratios=[0.1, 0.001]),
            "ratios: would make beta negative",
        ),
        (
            lambda: bs.RayleighDamping.from_ratios(frequencies=[3, 3], ratios=[0.1, 0.1]),
            "frequencies: must differ",
        ),
        (
            lambda: bs.RayleighDamping.from_ratios(frequencies=[0, 3], ratios=[0.1, 0.1]),
            "frequencies: must be positive",
        ),
        (
            lambda: bs.RayleighDamping.from_ratios(frequencies=[1, 3], ratios=[0.1]),
            "ratios: must be a list of 2 numbers",
        ),
    ],
)
def test_bad_rules_are_refused(make: Any, says: str) -> None:
    with pytest.raises(bs.InputError, match=says):
        make()
