from typing import Any

import numpy as np
import pytest

from bumpstop import InputError, Plane


def test_normal_is_kept_as_a_unit_vector() -> None:
    assert Plane(normal=(3.0, 0.0, -4.0)).normal == pytest.approx((0.6, 0.0, -0.8), abs=1e-16)


def test_a_unit_normal_is_kept_to_the_bit() -> None:
    assert Plane(normal=(0, 1, 0)).normal == (0.0, 1.0, 0.0)


def test_distance_of_many_displacements() -> None:
    wall = Plane(normal=(1, 0, 0), gap=0.5)
    displacements = np.array([[0.0, 9.0, 9.0], [-0.5, 9.0, 9.0], [-0.75, 9.0, 9.0]])
    assert wall.distance(displacements).tolist() == [0.5, 0.0, -0.25]


@pytest.mark.parametrize(
    ("normal", "what"),
    [
        ((0, 0, 0), "zero vector"),
        ((0, 1), "3 numbers"),
        ("0 1 0", "3 numbers"),
        ((0, float("nan"), 0), "finite"),
        ((0, True, 0), "a number"),
        (None, "3 numbers"),
    ],
)
def test_normals_that_are_none(normal: Any, what: str) -> None:
    with pytest.raises(InputError, match=what) as caught:
        Plane(normal=normal)
    assert caught.value.key == "normal"


def test_gap_must_be_finite() -> None:
    with pytest.raises(InputError, match="gap: must be finite"):
        Plane(normal=(0, 1, 0), gap=float("inf"))
