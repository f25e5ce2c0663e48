from typing import Any

import numpy as np
import pytest

from bumpstop import arguments
from bumpstop.errors import InputError


@pytest.mark.parametrize("value", [2, 2.0, np.float64(2.0), np.int64(2), np.float32(2.0)])
def test_numbers_of_any_kind_are_numbers(value: Any) -> None:
    number = arguments.finite("gap", value)
    assert type(number) is float
    assert number == 2.0


@pytest.mark.parametrize("value", [True, np.True_, "2", None, [2.0], 2j, float("nan"), 1e999])
def test_the_rest_are_not(value: Any) -> None:
    with pytest.raises(InputError, match="gap: must be") as caught:
        arguments.finite("gap", value)
    assert caught.value.key == "gap"


def test_positive_and_not_negative_part_at_zero() -> None:
    assert arguments.not_negative("gap", 0) == 0.0
    with pytest.raises(InputError, match="must be positive"):
        arguments.positive("gap", 0)
    with pytest.raises(InputError, match="must not be negative"):
        arguments.not_negative("gap", -1e-300)


@pytest.mark.parametrize("value", [0, -1, 1.0, True, "1"])
def test_a_count_is_a_whole_number_from_1_on(value: Any) -> None:
    with pytest.raises(InputError, match="modes: must be"):
        arguments.count("modes", value)


@pytest.mark.parametrize("value", [[1, 2, 3], (1.0, 2.0, 3.0), np.array([1, 2, 3])])
def test_vectors_may_be_lists_tuples_or_arrays(value: Any) -> None:
    assert arguments.vector("normal", value) == (1.0, 2.0, 3.0)


@pytest.mark.parametrize("value", [[], [1, [2]], "12", np.ones((2, 2)), np.float64(1.0), {1: 2}])
def test_what_is_no_series(value: Any) -> None:
    with pytest.raises(InputError, match="times: must be"):
        arguments.series("times", value)


def test_all_of_names_the_one_that_is_not() -> None:
    with pytest.raises(InputError, match=r"must hold ints only \(got 'two'\)"):
        arguments.all_of("numbers", int, [1, "two"])


def test_a_long_list_of_words_is_cut() -> None:
    hint = arguments.did_you_mean("xyz", [f"node {number}" for number in range(20)])
    assert hint.endswith("node 11 and 8 more")
