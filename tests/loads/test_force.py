from typing import Any

import numpy as np
import pytest

from bumpstop import InputError, ModalBasis, NodalForce


def basis() -> ModalBasis:
    return ModalBasis.from_modes(
        frequency=[3.0, 7.5],
        shapes={("P", "dx"): [1.0, 0.4], ("P", "dy"): [0.5, -2.0], ("P", "drz"): [0.1, 3.0]},
    )


def test_modal_force_is_the_work_on_each_mode() -> None:
    push = NodalForce("push", node="P", force=(2, -5, 0))
    np.testing.assert_allclose(push.modal_force(basis()), [2 - 2.5, 0.8 + 10], rtol=1e-15)


def test_a_moment_works_on_rotations() -> None:
    twist = NodalForce("twist", node="P", force=(1, 0, 0), moment=(0, 0, 10))
    np.testing.assert_allclose(twist.modal_force(basis()), [1 + 1, 0.4 + 30], rtol=1e-15)


def test_a_component_without_shape_is_refused() -> None:
    with pytest.raises(InputError, match="'dz'"):
        NodalForce("push", node="P", force=(0, 0, 1)).modal_force(basis())


@pytest.mark.parametrize("force", [(0, 1), "5 N", (0, float("nan"), 0), 5.0])
def test_a_force_has_three_finite_components(force: Any) -> None:
    with pytest.raises(InputError) as caught:
        NodalForce("push", node="P", force=force)
    assert caught.value.key == "force"
