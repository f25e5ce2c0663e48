"""Parameters of studies: what they hold, what they draw, what they refuse."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as some
from scipy import stats

import bumpstop as bs
from bumpstop.study.parameters import recorded_parameter

SHARES = np.linspace(0.0, 1.0, 101)


def test_values_keep_words_and_read_units() -> None:
    given_values = bs.Values(["plane", "2 mm", 3, 0.5])
    assert given_values.levels == ["plane", 0.002, 3, 0.5]
    assert given_values.written == ("plane", "2 mm", 3, 0.5)


def test_values_are_drawn_equally_often() -> None:
    drawn = bs.Values([1, 2, 3]).quantiles((np.arange(300) + 0.5) / 300)
    assert np.bincount(drawn)[1:].tolist() == [100, 100, 100]


@given(
    some.floats(1e-6, 1e6), some.floats(1e-6, 1e6), some.integers(2, 60), some.sampled_from([0, 1])
)
def test_ranges_step_evenly(start: float, end: float, count: int, log: int) -> None:
    if start == end:
        return
    found = bs.Range(start, end, count, ["linear", "log"][log]).levels
    assert len(found) == count
    assert (found[0], found[-1]) == pytest.approx((start, end), rel=1e-14)
    numbers = np.log(np.array(found, dtype=float)) if log else np.array(found, dtype=float)
    steps = np.diff(numbers)
    assert steps == pytest.approx(np.full(count - 1, steps.mean()), abs=1e-9 * abs(numbers).max())


def test_whole_ranges_are_whole() -> None:
    levels = bs.Range(4, 10, 4).levels
    assert levels == [4, 6, 8, 10]
    assert all(type(level) is int for level in levels)
    assert all(type(level) is float for level in bs.Range(4.0, 10, 4).levels)


def test_ranges_are_drawn_from_evenly_whatever_their_ends() -> None:
    assert bs.Range(0, 1).quantiles(SHARES).tolist() == SHARES.tolist()
    assert bs.Range(6, 4).quantiles(np.array([0.0, 0.3, 1.0])) == pytest.approx([6.0, 5.4, 4.0])
    ratios = bs.Range(1e-300, 1e300, spacing="log").quantiles(np.array([0.0, 0.5, 1.0]))
    assert ratios == pytest.approx([1e-300, 1.0, 1e300], rel=1e-12)


def test_keys_of_whole_numbers_draw_these_alone() -> None:
    drawn = bs.Range(4, 6).whole().quantiles((np.arange(300) + 0.5) / 300)
    assert np.bincount(drawn)[4:].tolist() == [100, 100, 100]
    assert bs.Range(6, 4).whole().quantiles(np.array([0.0, 0.5, 1.0])).tolist() == [6, 5, 4]
    assert bs.Range(1, 10, 4, spacing="log").whole().levels == [1, 2, 5, 10]
    with pytest.raises(bs.InputError, match="the same whole number more than once"):
        _ = bs.Range(1, 4, 9, spacing="log").whole().levels
    die = bs.Distribution("randint", low=1, high=7).whole().quantiles((np.arange(60) + 0.5) / 60)
    assert np.bincount(die)[1:].tolist() == [10] * 6
    between = bs.Distribution("normal", mean=1.0, standard_deviation=0.1)
    assert between.whole() is between
    for each in (bs.Range(1, 10, 4, spacing="log").whole(), bs.Distribution("poisson", mu=2.0)):
        assert recorded_parameter(each.record) == each


def test_numbers_of_numpy_are_numbers() -> None:
    one, half, three = np.array([1, 3])[0], np.array([0.5])[0], np.array([3.0])[0]
    assert bs.Values([one, half]).levels == [1, 0.5]
    assert bs.Range(one, three, 3).levels == [1.0, 2.0, 3.0]
    assert bs.Distribution("normal", mean=one, standard_deviation=half).record["mean"] == 1


@pytest.mark.parametrize(
    ("own", "known"),
    [
        (
            bs.Distribution("normal", mean="1 mm", standard_deviation="0.1 mm"),
            stats.norm(1e-3, 1e-4),
        ),
        (bs.Distribution("uniform", low=2.0, high="300 cm"), stats.uniform(2.0, 1.0)),
        (
            bs.Distribution("lognormal", median=5.0, sigma=0.2),
            stats.lognorm(s=0.2, scale=5.0),
        ),
        (bs.Distribution("weibull_min", c=1.5, scale=3.0), stats.weibull_min(1.5, scale=3.0)),
        (bs.Distribution("randint", low=2, high=7), stats.randint(2, 7)),
    ],
)
def test_distributions_are_those_of_scipy(own: bs.Distribution, known: object) -> None:
    inner = SHARES[1:-1]
    assert own.quantiles(inner).tolist() == known.ppf(inner).tolist()  # type: ignore[attr-defined]
    assert np.isfinite(own.quantiles(SHARES)).all()


def test_the_median_of_a_lognormal_is_its_median() -> None:
    (low, median, high) = bs.Distribution("lognormal", median=5.0, sigma=0.2).quantiles(
        stats.norm.cdf([-1.0, 0.0, 1.0])
    )
    assert (low, median, high) == pytest.approx((5 * math.exp(-0.2), 5, 5 * math.exp(0.2)))


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        (lambda: bs.Values([]), "values: must be a list of one value or more"),
        (lambda: bs.Values([1.0, math.inf]), "values.1: must be finite"),
        (lambda: bs.Range(1.0, 1.0), "to: is where the range starts"),
        (lambda: bs.Range(0.0, 1.0, spacing="log"), "from: must be positive for equal ratios"),
        (lambda: bs.Range(1.0, 2.0, spacing="lgo"), "unknown spacing (got 'lgo'); did you mean"),
        (lambda: bs.Range(1.0, 2.0, 10**12), "count: at most 20,000,000"),
        (lambda: bs.Range(-1.7e308, 1.7e308, 3), "to: is too far from where the range starts"),
        (
            lambda: bs.Distribution("lognormal", median="1 mm", sigma="1 mm"),
            "sigma: wrong unit: 'mm' is a length, expected a pure number",
        ),
        (lambda: bs.Range(1.0, 2.0, 0), "count: must be 1 or more"),
        (lambda: bs.Range(1.0, "2 quux"), "to: unknown unit (got 'quux')"),
        (lambda: bs.Distribution("normel"), "(got 'normel'); did you mean 'normal'?"),
        (lambda: bs.Distribution("normal", mean=1.0), "standard_deviation: is missing"),
        (
            lambda: bs.Distribution("normal", mean=1.0, sd=1.0),
            "unknown parameter (got 'sd'); known: mean, standard_deviation",
        ),
        (lambda: bs.Distribution("weibull_min"), "c: is missing; weibull_min needs it"),
        (lambda: bs.Distribution("weibull_min", c=-1.0), "no weibull_min distribution with these"),
        (lambda: bs.Distribution("uniform", low=2.0, high=1.0), "high: must be above low"),
        (lambda: bs.Distribution("uniform", low=2.0), "high: is missing"),
    ],
)
def test_what_is_refused(wrong: object, told: str) -> None:
    with pytest.raises(bs.InputError) as error:
        wrong()  # type: ignore[operator]
    assert told in str(error.value)


def test_a_distribution_that_does_not_scatter_is_refused_in_one_line() -> None:
    with pytest.raises(bs.InputError, match="there is no normal distribution with these"):
        bs.Distribution("normal", mean=1.0, standard_deviation=0.0)
