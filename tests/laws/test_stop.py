from typing import Any

import numpy as np
import pytest

from bumpstop import InputError, ModalBasis, Stop

GOOD: dict[str, Any] = {
    "node": "P",
    "normal": (0, 1, 0),
    "gap": 1e-3,
    "stiffness": 1e6,
    "damping": 0.0,
}


def basis() -> ModalBasis:
    return ModalBasis.from_modes(
        frequency=[3.0, 7.5],
        damping=0.01,
        shapes={("P", "dx"): [1.0, 0.4], ("P", "dy"): [0.5, -2.0], ("Q", "dx"): [0.0, 0.0]},
    )


@pytest.mark.parametrize(
    ("key", "value", "what"),
    [
        ("stiffness", 0.0, "must be positive"),
        ("stiffness", -1.0, "must be positive"),
        ("stiffness", float("nan"), "must be finite"),
        ("stiffness", "18 kN/m", "must be a number"),
        ("damping", -1e-9, "must not be negative"),
        ("damping", float("inf"), "must be finite"),
        ("gap", None, "must be a number"),
        ("gap", float("inf"), "must be finite"),
        ("normal", (0, 0, 0), "zero vector"),
        ("normal", (0, 1), "3 numbers"),
        ("normal", "0 1 0", "3 numbers"),
        ("normal", (0, float("nan"), 0), "finite"),
        ("normal", (0, True, 0), "a number"),
        ("node", "", "must be a name"),
        ("node", 7, "must be a name"),
        ("obstacle", "plan", "did you mean 'plane'"),
    ],
)
def test_refuses(key: str, value: Any, what: str) -> None:
    with pytest.raises(InputError, match=what) as caught:
        Stop("guide", **(GOOD | {key: value}))
    assert caught.value.key == key


def test_is_frozen() -> None:
    stop = Stop("guide", **GOOD)
    with pytest.raises(AttributeError):
        stop.stiffness = 1.0  # type: ignore[misc]  # what is tested


def test_a_normal_is_kept_as_a_unit_vector() -> None:
    stop = Stop("guide", **(GOOD | {"normal": (3.0, 0.0, -4.0)}))
    assert stop.normal == pytest.approx((0.6, 0.0, -0.8), abs=1e-16)
    assert Stop("guide", **GOOD).normal == (0.0, 1.0, 0.0)


def test_row_is_the_normal_times_the_shapes() -> None:
    stop = Stop("guide", **(GOOD | {"normal": (3, -4, 0)}))
    np.testing.assert_allclose(stop.row(basis()), [0.6 - 0.4, 0.24 + 1.6], rtol=1e-15)


def test_row_asks_for_no_shape_that_it_does_not_need() -> None:
    stop = Stop("guide", **(GOOD | {"node": "P", "normal": (-1, 0, 0)}))
    assert stop.row(basis()).tolist() == [-1.0, -0.4]


def test_a_node_without_shapes_is_named() -> None:
    with pytest.raises(InputError, match=r"'PP'.*did you mean 'P'"):
        Stop("guide", **(GOOD | {"node": "PP"})).row(basis())


def test_a_direction_without_shapes_is_named() -> None:
    with pytest.raises(InputError, match="'dz'"):
        Stop("guide", **(GOOD | {"normal": (0, 0, 1)})).row(basis())


def test_a_node_that_no_mode_moves_is_refused() -> None:
    with pytest.raises(InputError, match=r"no mode moves this node.*'Q'"):
        Stop("guide", **(GOOD | {"node": "Q", "normal": (1, 0, 0)})).row(basis())
