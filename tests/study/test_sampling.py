"""Which runs studies make."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from bumpstop import Distribution, InputError, Range, Sampling, Values
from bumpstop.study.parameters import Parameter
from bumpstop.study.sampling import planned

UNIT = Range(0.0, 1.0)


def unit_samples(method: str, count: int, seed: int = 0, dimensions: int = 2) -> np.ndarray:
    """Return samples of the unit cube, (run, parameter)."""
    names = [f"p{number}" for number in range(dimensions)]
    runs = planned(dict.fromkeys(names, UNIT), Sampling(method, count, seed))
    columns = runs.columns(0, runs.count)
    return np.array([columns[name] for name in names]).T


@given(some.lists(some.integers(1, 5), min_size=1, max_size=4), some.integers(0, 1000))
def test_a_grid_has_every_combination_once(sizes: list[int], cut: int) -> None:
    parameters = {f"p{n}": Values(list(range(size))) for n, size in enumerate(sizes)}
    runs = planned(parameters, Sampling(), slowest=["p1"])
    cut %= runs.count + 1
    parts = [runs.columns(0, cut), runs.columns(cut, runs.count)]
    rows = [row for part in parts for row in zip(*(part[name] for name in parameters), strict=True)]
    assert sorted(rows) == sorted(np.ndindex(*sizes))
    assert [tuple(runs.row(n)[name] for name in parameters) for n in range(len(rows))] == rows


def test_what_the_modes_depend_on_changes_least_often() -> None:
    parameters = {"stops.a.gap": Values([1, 2]), "basis.modes": Values([3, 4])}
    runs = planned(parameters, Sampling(), slowest=["basis.modes"])
    assert runs.columns(0, 4)["basis.modes"] == [3, 3, 4, 4]


def test_a_list_takes_values_side_by_side() -> None:
    runs = planned({"a": Values([1, 2]), "b": Values(["x", "y"])}, Sampling("list"))
    assert [runs.row(number) for number in range(2)] == [{"a": 1, "b": "x"}, {"a": 2, "b": "y"}]


@settings(max_examples=25)
@given(some.integers(1, 40), some.integers(0, 2**31), some.integers(1, 5))
def test_latin_hypercubes_have_one_sample_in_each_layer(
    count: int, seed: int, dimensions: int
) -> None:
    samples = unit_samples("latin_hypercube", count, seed, dimensions)
    layers = np.sort(np.floor(samples * count).astype(int), axis=0)
    assert (layers == np.arange(count)[:, np.newaxis]).all()


@settings(max_examples=20)
@given(some.integers(1, 6), some.integers(0, 2**31))
def test_sobol_samples_are_balanced(power: int, seed: int) -> None:
    # A net of 2^m points in base 2: each half of each axis has half of them, each layer one.
    count = 2**power
    samples = unit_samples("sobol", count, seed)
    layers = np.sort(np.floor(samples * count).astype(int), axis=0)
    assert (layers == np.arange(count)[:, np.newaxis]).all()


def test_drawn_samples_follow_their_distribution() -> None:
    parameter = {"a": Distribution("normal", mean=3.0, standard_deviation=0.5)}
    for method in ("monte_carlo", "latin_hypercube", "sobol"):
        drawn = planned(parameter, Sampling(method, 4096, 7)).columns(0, 4096)["a"]
        # Three standard errors of plain sampling; the others are better.
        assert np.mean(np.array(drawn)) == pytest.approx(3.0, abs=3 * 0.5 / 64)
        assert np.std(np.array(drawn)) == pytest.approx(0.5, abs=3 * 0.5 / 90)


@pytest.mark.parametrize("method", ["monte_carlo", "latin_hypercube", "sobol"])
def test_seeds(method: str) -> None:
    first = unit_samples(method, 16, seed=1)
    assert (first == unit_samples(method, 16, seed=1)).all()
    assert (first != unit_samples(method, 16, seed=2)).any()


@pytest.mark.parametrize(
    ("parameters", "sampling", "told"),
    [
        ({"a": UNIT}, Sampling(), 'parameters."a".count: is missing'),
        (
            {"a": Distribution("normal", mean=0, standard_deviation=1)},
            Sampling(),
            "draw samples: latin_hypercube",
        ),
        (
            {"a": Range(0, 1, 10**6), "b": Range(0.0, 1.0, 10**6)},
            Sampling(),
            "makes 1e+12 runs, at most 20,000,000",
        ),
        ({"a": UNIT}, Sampling("saltelli", 2**23), "count: makes 2.52e+07 runs, at most"),
        (
            {"a": Values([1]), "b": Values([1, 2])},
            Sampling("list"),
            "has 2 values, and 'a' has 1",
        ),
    ],
)
def test_what_does_not_fit_together(
    parameters: dict[str, Parameter], sampling: Sampling, told: str
) -> None:
    with pytest.raises(InputError) as error:
        planned(parameters, sampling)
    assert told in str(error.value)


@pytest.mark.parametrize(
    ("given_words", "told"),
    [
        (("sobl",), "unknown method (got 'sobl'); did you mean 'sobol'?"),
        (("sobol", 100), "must be a power of two for Sobol's samples (got 100); take 128"),
        (("monte_carlo",), "count: is missing"),
        (("monte_carlo", 10**12), "count: makes 1e+12 runs, at most 20,000,000"),
        (("grid", 10), "grid makes as many runs as the parameters tell (got 10)"),
        (("sobol", 4, -1), "seed: must be 0 or more"),
        (("saltelli", 100), "must be a power of two for Sobol's samples (got 100); take 128"),
        (("sobol", 4, 0, 0.1), "share: tells low from high values, which one_at_a_time alone has"),
        (("one_at_a_time", None, 0, 0.5), "share: must be below 0.5"),
    ],
)
def test_sampling_that_is_refused(given_words: tuple[Any, ...], told: str) -> None:
    with pytest.raises(InputError) as error:
        Sampling(*given_words)
    assert told in str(error.value)
