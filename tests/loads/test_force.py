from typing import Any

import numpy as np
import pytest

from bumpstop import InputError, ModalBasis, NodalForce, PointMass, RigidLink, Structure


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


def test_a_moment_where_nothing_has_inertia_is_refused() -> None:
    """A ball without rotary inertia: its rotations are left out of the modes."""
    ball = Structure(nodes={"P": (0, 0, 0)}, masses=[PointMass("ball", node="P", mass=2.0)])
    basis = ModalBasis.from_structure(ball, modes=3)
    push = NodalForce("push", node="P", force=(0, 0, 6.0)).modal_force(basis)
    assert push @ basis.row("P", "dz") == pytest.approx(3.0)
    twist = NodalForce("twist", node="P", moment=(0, 0, 1.0))
    with pytest.raises(InputError, match=r"node: a force here has no mass to move .*inertia"):
        twist.modal_force(basis)


def test_a_moment_on_a_rigid_link_finds_the_inertia_of_its_masses() -> None:
    """A dumbbell turns about the axes across it; about its own it has no inertia."""
    dumbbell = Structure(
        nodes={"A": (0, 0, 0), "B": (0.6, 0.8, 0)},
        masses=[PointMass(node, node=node, mass=2.0) for node in "AB"],
        links=[RigidLink("bar", nodes=("A", "B"))],
    )
    basis = ModalBasis.from_structure(dumbbell, modes=5)
    np.testing.assert_array_equal(basis.omega2, 0.0)
    across = NodalForce("turn", node="A", moment=(-0.8, 0.6, 0.0)).modal_force(basis)
    rate = np.array([basis.row("B", dof) for dof in ("drx", "dry", "drz")]) @ across
    np.testing.assert_allclose(rate, np.array([-0.8, 0.6, 0.0]), atol=1e-12)  # J = 1 kg m2
    along = NodalForce("spin", node="A", moment=(0.6, 0.8, 0.0))
    with pytest.raises(InputError, match="no mass to move"):
        along.modal_force(basis)
