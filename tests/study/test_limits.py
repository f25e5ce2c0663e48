"""Limits of refined values, and where published values lie among them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import curve_fit
from scipy.stats import t as student

from bumpstop.study.convergence.limits import extrapolated, orders_towards
from bumpstop.study.convergence.published import position_of

SIZES = np.array([1.0, 2.0, 4.0, 8.0])


@given(
    limit=st.floats(-10, 10),
    amplitude=st.sampled_from([-3.0, -0.1, 0.02, 1.0]),
    order=st.floats(0.7, 5.0),
)
def test_a_power_law_has_its_order_and_its_limit(
    limit: float, amplitude: float, order: float
) -> None:
    found = extrapolated((limit + amplitude * SIZES**-order)[:, np.newaxis])
    assert found.order == pytest.approx(order, rel=1e-4)
    assert found.values == pytest.approx(limit, abs=1e-8)
    assert found.uncertainty == pytest.approx(abs(amplitude) * 8.0**-order, rel=1e-4)


def test_limits_lie_within_their_uncertainty_beside_a_second_term() -> None:
    rungs = (3.0 + SIZES**-2 + 0.5 * SIZES**-4)[:, np.newaxis]
    found = extrapolated(rungs)
    assert abs(found.values[0] - 3.0) < 0.2 * found.uncertainty[0]


@pytest.mark.parametrize(
    "errors",
    [[1.0, -0.5, 0.25, -0.125], [1.0, 0.9, 0.2, 0.1], [0.1, 0.2, 0.4, 0.8], [1.0, 0.5, 0.49, 0.3]],
    ids=["alternating", "uneven", "growing", "slow"],
)
def test_what_does_not_shrink_steadily_has_no_order(errors: list[float]) -> None:
    rungs = np.cumsum([0.0, *errors])[:, np.newaxis]
    found = extrapolated(rungs)
    assert np.isnan(found.order[0])
    assert found.values[0] == rungs[-1, 0]
    assert found.uncertainty[0] == pytest.approx(max(abs(errors[-1]), abs(errors[-2])))


def test_values_that_are_missing_have_no_limit() -> None:
    found = extrapolated(np.array([[1.0], [np.nan], [1.1], [1.2]]))
    assert np.isnan(found.order[0])
    assert found.values[0] == 1.2


def test_orders_towards_a_known_limit_end_where_rounding_begins() -> None:
    rungs = np.array([[1.0 + 1e-3, 2.0], [1.0 + 1e-6, 2.0 + 1e-13], [1.0 + 1e-9, 2.0]])
    orders = orders_towards(np.array([1.0, 2.0]), [1.0, 10.0, 100.0], rungs)
    assert orders[0] == pytest.approx(3.0)
    assert np.isnan(orders[1])


def test_the_position_is_that_of_a_regression_through_the_origin() -> None:
    rng = np.random.default_rng(7)
    computed, way = rng.normal(size=12), rng.normal(size=12)
    allowed = rng.uniform(0.5, 2.0, size=12)
    published = computed + 0.3 * way + 0.05 * rng.normal(size=12)
    found = position_of(published, computed, computed + way, allowed)
    (share,), ((variance,),) = curve_fit(
        lambda x, share: share * x, way, published - computed, p0=[0.0], sigma=allowed
    )
    assert found is not None
    assert found.share == pytest.approx(share)
    assert found.error == pytest.approx(student.ppf(0.975, 11) * np.sqrt(variance), rel=1e-6)


def test_no_position_along_no_way() -> None:
    values = np.array([1.0, 2.0, 3.0])
    assert position_of(values + 0.1, values, values, np.ones(3)) is None
    assert position_of(values[:2], values[:2], values[:2] + 1.0, np.ones(2)) is None
    missing = np.array([np.nan, 2.0, 3.0])
    assert position_of(values, missing, values + 1.0, np.ones(3)) is None
