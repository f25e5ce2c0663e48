from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation as Reference

from bumpstop import InputError, Rotation
from bumpstop.modal.substructure.rotation import rotation_matrix


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 2, 0), (0.3, -0.5, 2.0), (1e200, 1e200, 0)])
@pytest.mark.parametrize("angle", [0.0, 0.1, -2.5, 7.0])
def test_rotations_are_those_of_scipy(axis: Any, angle: float) -> None:
    unit = np.array(axis) / max(axis)
    unit /= np.linalg.norm(unit)
    expected = Reference.from_rotvec(angle * unit).as_matrix()
    np.testing.assert_allclose(Rotation(axis, angle).matrix, expected, atol=1e-15)


@pytest.mark.parametrize("quarters", [1, 2, 3, -1, 4])
def test_quarter_turns_are_exact(quarters: int) -> None:
    matrix = Rotation((0, 0, 1), quarters * math.pi / 2).matrix
    assert set(matrix.ravel().tolist()) <= {-1.0, 0.0, 1.0}
    np.testing.assert_array_equal(matrix @ matrix.T, np.eye(3))


def test_a_rotation_may_be_a_matrix_or_nothing() -> None:
    np.testing.assert_array_equal(rotation_matrix("rotation", None), np.eye(3))
    turn = Rotation((1, 2, 3), 0.4).matrix
    np.testing.assert_array_equal(rotation_matrix("rotation", turn), turn)
    np.testing.assert_array_equal(rotation_matrix("rotation", turn.tolist()), turn)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("90 deg", "rotation: must be a Rotation or a matrix of 3 by 3"),
        ([[1, 0], [0, 1]], "rotation: must be a Rotation or a matrix"),
        ([1, 0, 0], r"rotation\[0\]: must be a list of 3 numbers"),
        ([[1, 0, 0], [0, 1, 0], [0, 0, 2]], "rotation: is not a rotation"),
        ([[1, 0, 0], [0, 1, 0], [0, 0, -1]], "rotation: mirrors the component"),
    ],
)
def test_what_is_no_rotation_is_refused(value: Any, message: str) -> None:
    with pytest.raises(InputError, match=message):
        rotation_matrix("rotation", value)


@pytest.mark.parametrize(("axis", "angle"), [((0, 0, 0), 1.0), ((0, 0, 1), math.nan), ((1, 2), 0)])
def test_rotations_need_an_axis_and_an_angle(axis: Any, angle: float) -> None:
    with pytest.raises(InputError):
        Rotation(axis, angle)
