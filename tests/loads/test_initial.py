from typing import Any

import numpy as np
import pytest

from bumpstop import (
    InputError,
    ModalBasis,
    ModalState,
    PointMass,
    RigidRotation,
    Structure,
    Support,
)

from ..hinged_beam import hinged_beam


def two_modes() -> ModalBasis:
    return ModalBasis.from_modes(frequency=[1.0, 2.0], shapes={("P", "dx"): [1.0, 1.0]})


def test_modal_state_is_taken_as_it_is() -> None:
    state = ModalState(displacement=np.array([0.1, 0.2]), velocity=[1, 0])
    displacement, velocity = state.modal_state(two_modes())
    assert displacement.tolist() == [0.1, 0.2]
    assert velocity.tolist() == [1.0, 0.0]


def test_what_is_left_out_is_zero() -> None:
    displacement, velocity = ModalState(velocity=[1.0, 2.0]).modal_state(two_modes())
    assert displacement.tolist() == [0.0, 0.0]
    assert velocity.tolist() == [1.0, 2.0]


@pytest.mark.parametrize("values", [[], "rest", [float("nan")], [[1.0]], 3.0])
def test_modal_state_is_finite_numbers(values: Any) -> None:
    with pytest.raises(InputError) as caught:
        ModalState(velocity=values)
    assert caught.value.key == "velocity"


def test_modal_state_has_a_number_a_mode() -> None:
    with pytest.raises(InputError, match="one number for each of the 2 modes"):
        ModalState(displacement=[0.0]).modal_state(two_modes())


@pytest.mark.parametrize("at", [(0.0, 0.0), (1.7, -0.4)])
def test_a_rotation_about_the_hinge_is_the_rigid_mode_alone(at: tuple[float, float]) -> None:
    """With 12-digit modes, all the velocity is in the rigid mode, rate sqrt(inertia)."""
    basis = ModalBasis.from_structure(hinged_beam(at=at), modes=10)
    displacement, velocity = RigidRotation(about="A", rate=(0, 0, -3.8)).modal_state(basis)
    inertia = 2400 * 0.014**2 * 0.783**3 / 3 + 2400 * 0.014**4 / 12 * 0.783
    assert not displacement.any()
    assert velocity[0] == pytest.approx(-3.8 * np.sqrt(inertia), rel=1e-12)
    np.testing.assert_allclose(velocity[1:], 0.0, atol=1e-12 * abs(velocity[0]))


def test_the_centre_of_a_rotation_stays_in_place() -> None:
    """Two masses, free across the line that they stand on: nothing but the centre decides."""
    across = Support(nodes="all", fixed=("dx", "dz", "drx", "dry", "drz"))
    masses = [PointMass(name, node=name, mass=2.0) for name in "PQ"]
    nodes = {"P": (1, 5, 0), "Q": (3, 5, 0)}
    pair = Structure(nodes=nodes, masses=masses, supports=[across])
    basis = ModalBasis.from_structure(pair, modes="all", rigid_modes=2)
    for about, expected in (("P", (0.0, 8.0)), ("Q", (-8.0, 0.0))):
        _, velocity = RigidRotation(about, rate=(0, 0, 4.0)).modal_state(basis)
        found = [basis.row(node, "dy") @ velocity for node in "PQ"]
        np.testing.assert_allclose(found, expected, atol=1e-14)


def test_an_unknown_centre_is_named(hinged: ModalBasis) -> None:
    with pytest.raises(InputError, match=r"about: .*'AA'") as caught:
        RigidRotation(about="AA", rate=(0, 0, 1)).modal_state(hinged)
    assert caught.value.hint == "did you mean 'A'?"


@pytest.mark.parametrize(
    ("about", "rate", "moved"),
    [
        ("A", (3.8, 0.0, 0.0), r"A drx, which is held, at 3.8 rad/s"),
        ("A", (0.0, 300.0, -3.8), r"B dz, which is held, at -234.9 m/s"),
        ("B", (0.0, 0.0, -3.8), r"A dy, which is held, at 2.975 m/s"),
    ],
)
def test_a_rotation_that_the_supports_forbid_is_refused(
    about: str, rate: tuple[float, float, float], moved: str, hinged: ModalBasis
) -> None:
    with pytest.raises(InputError, match=f"rate: would move {moved}.*; turn about a hinge"):
        RigidRotation(about, rate).modal_state(hinged)


def test_a_rotation_needs_a_structure() -> None:
    with pytest.raises(InputError, match="give a ModalState"):
        RigidRotation(about="P", rate=(0, 0, 1)).modal_state(two_modes())
