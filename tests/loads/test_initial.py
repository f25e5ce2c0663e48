from typing import Any

import numpy as np
import pytest

from bumpstop import InputError, ModalBasis, ModalState, RigidRotation


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


def test_a_rotation_about_the_hinge_is_the_rigid_mode_alone(hinged_beam: ModalBasis) -> None:
    """With 12-digit modes, all the velocity is in the rigid mode, rate sqrt(inertia)."""
    displacement, velocity = RigidRotation(about="A", rate=(0, 0, -3.8)).modal_state(hinged_beam)
    inertia = 2400 * 0.014**2 * 0.783**3 / 3 + 2400 * 0.014**4 / 12 * 0.783
    assert not displacement.any()
    assert velocity[0] == pytest.approx(-3.8 * np.sqrt(inertia), rel=1e-12)
    np.testing.assert_allclose(velocity[1:], 0.0, atol=1e-12 * abs(velocity[0]))


def test_an_unknown_centre_is_named(hinged_beam: ModalBasis) -> None:
    with pytest.raises(InputError, match=r"about: .*'AA'") as caught:
        RigidRotation(about="AA", rate=(0, 0, 1)).modal_state(hinged_beam)
    assert caught.value.hint == "did you mean 'A'?"


def test_a_rotation_that_the_supports_forbid_is_refused(hinged_beam: ModalBasis) -> None:
    with pytest.raises(InputError, match="no mode takes part"):
        RigidRotation(about="A", rate=(3.8, 0, 0)).modal_state(hinged_beam)


def test_a_rotation_needs_a_structure() -> None:
    with pytest.raises(InputError, match="give a ModalState"):
        RigidRotation(about="P", rate=(0, 0, 1)).modal_state(two_modes())
