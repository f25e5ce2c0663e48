"""Which runs a study makes: grids, lists, and samples drawn by chance or spread evenly."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.arguments import FloatArray, count, one_of, positive
from bumpstop.errors import InputError
from bumpstop.io.case.keys import keyed
from bumpstop.study.parameters import MOST_RUNS, Level, Parameter, Values

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["CROWD", "DRAWN", "SAMPLINGS", "SIDES", "Runs", "Sampling", "planned", "unit_samples"]

DRAWN = ("latin_hypercube", "sobol", "monte_carlo", "saltelli")
BY_SHARES = (*DRAWN, "one_at_a_time")
"""Methods that ask parameters for quantiles."""
SAMPLINGS = ("grid", "list", "continuation", *BY_SHARES, "worst_case")
CROWD = 8
"""Runs of a generation for each parameter, where the worst case is searched for."""
SIDES = ("low", "middle", "high")
"""Runs of each parameter that goes alone."""
_TAIL = 0.05


@dataclass(frozen=True)
class Sampling:
    """How values of several parameters are put together to runs.

    Parameters
    ----------
    method
        ``"grid"``: each value with each of the others'. ``"list"``: the first values
        together, then the second ones, ... ``"continuation"``: so, too, first up and then down
        from the last values to the first, each run from the state in which the one before it
        ended. ``"latin_hypercube"`` (M. D. McKay, R. J. Beckman,
        W. J. Conover, *Technometrics* 21, 1979), ``"sobol"`` (scrambled; A. B. Owen, *Journal
        of Complexity* 14, 1998) and ``"monte_carlo"`` draw samples. ``"saltelli"`` (A. Saltelli,
        *Computer Physics Communications* 145, 2002) draws two of ``"sobol"``, and for each
        parameter makes the first once more with that parameter taken from the second, which
        tells Sobol's indices. ``"one_at_a_time"``: for each parameter, a run where it is low, one
        where it is in its middle and one where it is high; the others are in their middle.
    count
        How many samples are drawn; a power of two for ``"sobol"`` and ``"saltelli"``, which
        makes ``count (2 + parameters)`` runs.
    seed
        Another seed draws other samples, the same one the same.
    share
        For ``"one_at_a_time"``: low is the value below which this share of the parameter lies,
        high the one above which as much lies; 0.05 where left out.
    of
        For ``"worst_case"``: the output, a single number, that is made largest; the only one
        where left out.

    Raises
    ------
    InputError
        If there is no such method, or it cannot draw so many.
    """

    method: str = "grid"
    count: int | None = None
    seed: int = 0
    share: float | None = None
    of: str | None = None

    def __post_init__(self) -> None:
        one_of("method", self.method, SAMPLINGS)
        count("seed", self.seed, least=0)
        self._check_share()
        if self.of is not None and self.method != "worst_case":
            what = "is what a worst_case is searched for of, and this is none"
            raise InputError(what, key="of", value=self.of)
        if self.method not in (*DRAWN, "worst_case"):
            if self.count is not None:
                what = f"{self.method} makes as many runs as the parameters tell"
                raise InputError(what, key="count", value=self.count)
            return
        if self.count is None:
            raise InputError("is missing", key="count", hint="say how many")
        _check_number("count", count("count", self.count))
        if self.method in _POWERS_OF_TWO and self.count & (self.count - 1):
            more = 2 ** math.ceil(math.log2(self.count))
            what = "must be a power of two for Sobol's samples"
            raise InputError(what, key="count", value=self.count, hint=f"take {more}")

    @property
    def record(self) -> dict[str, Any]:
        """What it is, for a study to be known again by."""
        if self.method in DRAWN:
            return {"method": self.method, "count": self.count, "seed": self.seed}
        if self.method == "worst_case":
            told = {"method": self.method, "count": self.count, "seed": self.seed}
            return told if self.of is None else told | {"of": self.of}
        if self.method == "one_at_a_time":
            return {"method": self.method, "share": self.tail}
        return {"method": self.method}

    @property
    def tail(self) -> float:
        """The share of a parameter below its low value."""
        return _TAIL if self.share is None else self.share

    def _check_share(self) -> None:
        if self.share is None:
            return
        if self.method != "one_at_a_time":
            what = "tells low from high values, which one_at_a_time alone has"
            raise InputError(what, key="share", value=self.share)
        if positive("share", self.share) >= 0.5:
            raise InputError("must be below 0.5", key="share", value=self.share)


_POWERS_OF_TWO = ("sobol", "saltelli")


class Runs:
    """The values of all parameters in each run.

    Parameters
    ----------
    levels
        The values of each parameter by name.
    shape
        How many values each has on a grid, in the order of `levels`; None where the n-th
        values of all belong together.
    """

    def __init__(
        self, levels: Mapping[str, Sequence[Level] | NDArray[Any]], shape: tuple[int, ...] | None
    ) -> None:
        self.names = tuple(levels)
        self.levels = dict(levels)
        self.shape = shape
        self.count = math.prod(shape) if shape else len(next(iter(levels.values())))
        self.known = self.count
        """Runs whose values are known, which a search tells as it goes."""

    def row(self, number: int) -> dict[str, Level]:
        """Return the values in one run, counted from 0."""
        numbers = self._numbers(np.array([number]))
        return {name: _plain(self.levels[name][numbers[name][0]]) for name in self.names}

    def tell(self, start: int, columns: Mapping[str, Sequence[Level] | NDArray[Any]]) -> None:
        """Set the values of the parameters in some runs, which a search has told."""
        for name, values in columns.items():
            levels = self.levels[name]
            assert isinstance(levels, np.ndarray)
            levels[start : start + len(values)] = values
            self.known = max(self.known, start + len(values))

    def columns(self, start: int, end: int) -> dict[str, list[Level]]:
        """Return the values of each parameter in the runs from start to before end."""
        numbers = self._numbers(np.arange(start, end))
        return {
            name: [_plain(self.levels[name][number]) for number in numbers[name]]
            for name in self.names
        }

    def _numbers(self, runs: NDArray[np.int64]) -> dict[str, Any]:
        """Return which of its levels each parameter has."""
        if self.shape is None:
            return dict.fromkeys(self.names, runs)
        return dict(zip(self.names, np.unravel_index(runs, self.shape), strict=True))


def planned(
    parameters: Mapping[str, Parameter], sampling: Sampling, slowest: Sequence[str] = ()
) -> Runs:
    """Return the runs that a study makes.

    Parameters
    ----------
    parameters
        What varies, by name; at least one.
    sampling
        How their values are put together.
    slowest
        Parameters that change least often from run to run of a grid.

    Raises
    ------
    InputError
        If the parameters have no values of the kind that the sampling needs, or make too many
        runs.
    """
    if sampling.method in BY_SHARES:
        if sampling.method == "saltelli":
            _check_number("count", (sampling.count or 0) * (2 + len(parameters)))
        shares = unit_samples(sampling, len(parameters))
        drawn = zip(parameters.items(), shares.T, strict=True)
        return Runs({name: each.quantiles(column) for (name, each), column in drawn}, None)
    if sampling.method == "worst_case":
        return _searched(parameters, sampling.count or 0)
    levels = {name: _levels(name, each) for name, each in parameters.items()}
    if sampling.method == "list":
        _check_lengths(levels)
        return Runs(levels, None)
    if sampling.method == "continuation":
        _check_lengths(levels)
        return Runs({name: [*each, *each[::-1]] for name, each in levels.items()}, None)
    ordered = {name: levels[name] for name in sorted(levels, key=lambda name: name not in slowest)}
    shape = tuple(len(values) for values in ordered.values())
    _check_number("parameters", math.prod(shape))
    return Runs(ordered, shape)


def _searched(parameters: Mapping[str, Parameter], most: int) -> Runs:
    """Return the runs of a search; others of each parameter stand for values not yet known."""
    generation = CROWD * len(parameters)
    if most < generation:
        what = f"a generation has {generation} runs, {CROWD} for each parameter"
        raise InputError(what, key="count", value=most, hint="ask for as many or more")
    runs = most - most % generation
    for name, each in parameters.items():
        if isinstance(each, Values) and len(each.levels) > runs:
            what = f"has {len(each.levels)} values, and the search {runs} runs"
            raise InputError(what, key=f'parameters."{name}"', hint="take a range")
    shares = (np.arange(runs) + 0.5) / runs
    found = Runs({name: each.quantiles(shares) for name, each in parameters.items()}, None)
    found.known = 0
    return found


def unit_samples(sampling: Sampling, dimensions: int) -> FloatArray:
    """Return samples of the unit cube, (run, dimension), as a method that takes shares has them."""
    from scipy.stats import qmc

    if sampling.method == "saltelli":
        pairs = unit_samples(Sampling("sobol", sampling.count, sampling.seed), 2 * dimensions)
        return _mixed(*np.split(pairs, 2, axis=1))
    if sampling.method == "one_at_a_time":
        return _each_alone(dimensions, sampling.tail)
    number = sampling.count or 0
    generator = np.random.default_rng(sampling.seed)
    if sampling.method == "monte_carlo":
        return generator.random((number, dimensions))
    kind = qmc.Sobol if sampling.method == "sobol" else qmc.LatinHypercube
    shares: FloatArray = kind(dimensions, rng=generator).random(number)
    return shares


def _mixed(one: FloatArray, other: FloatArray) -> FloatArray:
    """Return two samples, and the first with each dimension in turn taken from the second."""
    blocks = [one, other]
    for dimension in range(one.shape[1]):
        block = one.copy()
        block[:, dimension] = other[:, dimension]
        blocks.append(block)
    return np.concatenate(blocks)


def _each_alone(dimensions: int, tail: float) -> FloatArray:
    """Return middles, but for one dimension in turn that is low, in its middle and high."""
    shares = np.full((dimensions, len(SIDES), dimensions), 0.5)
    own = np.arange(dimensions)
    shares[own, :, own] = tail, 0.5, 1.0 - tail
    return shares.reshape(-1, dimensions)


def _levels(name: str, parameter: Parameter) -> list[Level]:
    with keyed(f'parameters."{name}"'):
        return parameter.levels


def _check_lengths(levels: Mapping[str, Sequence[Level]]) -> None:
    first, *others = levels
    for name in others:
        if len(levels[name]) != len(levels[first]):
            what = f"has {len(levels[name])} values, and {first!r} has {len(levels[first])}"
            hint = "a list takes them side by side; a grid combines them"
            raise InputError(what, key=f'parameters."{name}"', hint=hint)


def _check_number(key: str, number: int) -> None:
    if number > MOST_RUNS:
        hint = "draw samples, or cut the study into several"
        raise InputError(f"makes {number:.3g} runs, at most {MOST_RUNS:,}", key=key, hint=hint)


def _plain(level: Any) -> Level:
    """Return a level as Python's own number, as a case file has it."""
    plain: Level = level.item() if isinstance(level, np.generic) else level
    return plain
