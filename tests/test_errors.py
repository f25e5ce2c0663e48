"""How an error tells the value that was wrong."""

from typing import Any

import numpy as np
import pytest

import bumpstop as bs


@pytest.mark.parametrize(
    ("value", "told"),
    [
        (np.float64(-1.0), "(got -1.0)"),
        (np.int32(3), "(got 3)"),
        ((np.float64(0.5), "A"), "(got (0.5, 'A'))"),
        ([np.True_, None], "(got [True, None])"),
        (np.array([1.0, 2.0]), "(got [1.0, 2.0])"),
        ("dz", "(got 'dz')"),
    ],
)
def test_numbers_of_numpy_are_told_as_they_are_written(value: Any, told: str) -> None:
    assert str(bs.InputError("is wrong", value=value)) == f"is wrong {told}"
