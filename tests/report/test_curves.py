"""Thinned curves keep what matters."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import bumpstop as bs
from bumpstop.report.curves import MOST_POINTS, contact_spans, instants, thin

seeds = st.integers(0, 2**32 - 1)


@given(seed=seeds, count=st.integers(1, 5000), at_most=st.integers(10, 300))
def test_ends_and_extremes_stay_and_the_bound_holds(seed: int, count: int, at_most: int) -> None:
    values = np.random.default_rng(seed).normal(size=count)
    kept = thin(values, at_most=at_most)
    assert len(kept) <= at_most
    assert np.all(np.diff(kept) > 0)
    assert {0, count - 1, int(values.argmin()), int(values.argmax())} <= set(kept.tolist())


@given(seed=seeds, count=st.integers(500, 5000))
def test_what_must_stay_stays(seed: int, count: int) -> None:
    random = np.random.default_rng(seed)
    keep = random.random(count) < 0.01
    kept = thin(random.normal(size=count), keep=keep, at_most=200)
    assert set(np.flatnonzero(keep).tolist()) <= set(kept.tolist())


def test_a_thinned_curve_looks_the_same() -> None:
    """No point lies further from the drawn curve than from the extremes of its run."""
    x = np.linspace(0.0, 40.0, 50_000)
    values = np.sin(x**2 / 8.0)
    kept = thin(values)
    drawn = np.interp(x, x[kept], values[kept])
    assert np.max(np.abs(drawn - values)) < 0.05


def test_kinks_and_extra_instants_are_among_the_times(soft: bs.Response) -> None:
    opened = soft.impact_table()["end"][0]
    times = instants(soft, [1.23456e-3])
    assert {opened, 1.23456e-3, 0.0, 0.02} <= set(times.tolist())
    assert np.all(np.diff(times) > 0)


def test_spans_are_those_of_the_stop_and_end_with_the_run(bouncing: bs.Response) -> None:
    spans = contact_spans(bouncing, "floor")
    table = bouncing.impact_table()
    assert [start for start, _ in spans] == table["start"]
    assert all(start < end <= 3.0 for start, end in spans)
    assert contact_spans(bouncing, "ceiling") == []


def test_the_default_bound_is_no_finer_than_a_wide_screen() -> None:
    assert len(thin(np.random.default_rng(1).normal(size=100_000))) <= MOST_POINTS
