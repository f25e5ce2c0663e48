import numpy as np
import pytest
from numpy.testing import assert_allclose

from bumpstop.arguments import FloatArray
from bumpstop.post.quadrature import integrals


def waves(times: FloatArray) -> FloatArray:
    return np.stack([np.cos(300.0 * times), np.exp(-times)], axis=1)


def test_many_periods_in_one_interval() -> None:
    starts, ends = np.array([0.0, 1.0]), np.array([1.0, 7.5])
    sines = (np.sin(300.0 * ends) - np.sin(300.0 * starts)) / 300.0
    expected = np.stack([sines, np.exp(-starts) - np.exp(-ends)], axis=1)
    assert_allclose(integrals(waves, starts, ends), expected, rtol=0, atol=1e-14)


def test_a_kink_is_closed_in_upon() -> None:
    found = integrals(lambda t: np.abs(t - 1.0 / 3.0)[:, None], np.zeros(1), np.ones(1), 1e-14)
    assert found[0, 0] == pytest.approx(0.5 * (1.0 + 4.0) / 9.0, abs=1e-13)


def test_no_interval_has_no_integral() -> None:
    assert integrals(waves, np.empty(0), np.empty(0)).shape == (0, 2)
