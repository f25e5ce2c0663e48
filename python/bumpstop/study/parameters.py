"""What varies in a study: listed values, ranges and distributions."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

import numpy as np

from bumpstop.arguments import FloatArray, count, one_of
from bumpstop.errors import InputError, blamed
from bumpstop.io.units import Dimension, read_number_of_any_unit, read_quantity

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = [
    "MOST_RUNS",
    "Distribution",
    "Level",
    "Parameter",
    "Range",
    "Values",
    "as_parameter",
    "recorded_parameter",
]

Level: TypeAlias = float | int | str | bool
"""A value of a parameter, as a case file may have it."""

MOST_RUNS = 20_000_000
"""The most runs of a study."""

_PURE = Dimension("a pure number", "", "0.1")

_LEAST_SHARE = 2.0**-53
"""Shares are kept this far from 0 and 1, where unbounded distributions have no quantile."""


class Parameter(Protocol):
    """How one number of the case varies."""

    @property
    def levels(self) -> list[Level]:
        """The values on a grid or in a list; raises InputError where there are none."""

    @property
    def written(self) -> tuple[object, ...]:
        """Values as the user wrote them, for the case to check their units."""

    @property
    def spread(self) -> tuple[str, ...]:
        """Texts with units of differences of values, for the case to check their units."""

    @property
    def record(self) -> dict[str, Any]:
        """What it is, for a study to be known again by."""

    def quantiles(self, shares: FloatArray) -> NDArray[Any]:
        """Return the values below which these shares, from 0 to 1, of all values lie."""

    def whole(self) -> Parameter:
        """Return it for a key of the case that takes whole numbers alone."""


@dataclass(frozen=True)
class Values:
    """Values that are listed.

    Where samples are drawn, each is drawn as often as the others.

    Parameters
    ----------
    values
        Numbers in SI units, texts with units, or words of the case file, such as the shapes
        of obstacles.

    Raises
    ------
    InputError
        If there is none, or one is neither a number nor a text.
    """

    values: Sequence[Level]

    def __post_init__(self) -> None:
        given = self.values
        if isinstance(given, str) or not isinstance(given, Sequence) or not given:
            raise InputError("must be a list of one value or more", key="values", value=given)
        given = [_plain(value) for value in given]
        for number, value in enumerate(given):
            if not isinstance(value, int | float | str):
                what = "must be a number or a text"
                raise InputError(what, key=f"values.{number}", value=value)
            if isinstance(value, float) and not math.isfinite(value):
                raise InputError("must be finite", key=f"values.{number}", value=value)
        object.__setattr__(self, "values", tuple(given))

    @property
    def levels(self) -> list[Level]:
        """The values, those with units in SI units."""
        return [_in_si(value) for value in self.values]

    @property
    def written(self) -> tuple[object, ...]:
        """The values as they are written."""
        return tuple(self.values)

    @property
    def spread(self) -> tuple[str, ...]:
        """Nothing: values are no differences."""
        return ()

    @property
    def record(self) -> dict[str, Any]:
        """The values."""
        return {"values": list(self.values)}

    def quantiles(self, shares: FloatArray) -> NDArray[Any]:
        """Return values, each for the same part of the shares."""
        levels = np.array(self.levels, dtype=None if _are_numbers(self.levels) else object)
        chosen: NDArray[Any] = levels[np.minimum(shares * len(levels), len(levels) - 1).astype(int)]
        return chosen

    def whole(self) -> Values:
        """Return the values as they are."""
        return self


@dataclass(frozen=True)
class Range:
    """Values from one number to another, both included.

    Where samples are drawn, they are spread evenly between the ends, or so their logarithms. For
    keys of a case that take whole numbers alone, such as a number of modes, only these are drawn,
    each as often as the others, and equal ratios are rounded to them.

    Parameters
    ----------
    start, end
        Numbers in SI units, or texts with units. Where both are whole numbers, and the steps
        between them, too, the values on a grid are whole.
    count
        How many on a grid; none is needed where samples are drawn.
    spacing
        ``"linear"``, or ``"log"`` for equal ratios.

    Raises
    ------
    InputError
        If the ends are the same, are no numbers or, for equal ratios, not positive; or the
        count is below 1 or larger than any study.

    Examples
    --------
    >>> Range("10 N/m", "1 kN/m", 3, spacing="log").levels
    [10.0, 100.0, 1000.0]
    >>> Range(2, 6, 3).levels
    [2, 4, 6]
    """

    start: float | str
    end: float | str
    count: int | None = None
    spacing: str = "linear"

    def __post_init__(self) -> None:
        one_of("spacing", self.spacing, ("linear", "log"))
        object.__setattr__(self, "start", _plain(self.start))
        object.__setattr__(self, "end", _plain(self.end))
        low, high = self._ends
        if not math.isfinite(high - low):
            what = "is too far from where the range starts"
            raise InputError(what, key="to", value=self.end)
        if low == high:
            raise InputError("is where the range starts", key="to", value=self.end)
        if self.spacing == "log" and min(low, high) <= 0.0:
            key, value = ("from", self.start) if low <= 0.0 else ("to", self.end)
            raise InputError("must be positive for equal ratios", key=key, value=value)
        if self.count is not None and count("count", self.count) > MOST_RUNS:
            raise InputError(f"at most {MOST_RUNS:,}", key="count", value=self.count)

    @property
    def levels(self) -> list[Level]:
        """Values in equal steps or ratios."""
        if self.count is None:
            raise InputError("is missing", key="count", hint="say how many values")
        low, high = self._ends
        if self.spacing == "log":
            ratios: list[Level] = np.geomspace(low, high, self.count).tolist()
            return ratios
        values: list[Level] = np.linspace(low, high, self.count).tolist()
        whole: list[Level] = [round(float(value)) for value in values]
        return whole if self.is_whole and whole == values else values

    @property
    def written(self) -> tuple[object, ...]:
        """Both ends as they are written."""
        return (self.start, self.end)

    @property
    def spread(self) -> tuple[str, ...]:
        """Nothing: its ends are values."""
        return ()

    @property
    def record(self) -> dict[str, Any]:
        """Ends, count and spacing."""
        ends = {"from": self.start, "to": self.end}
        return {**ends, "count": self.count, "spacing": self.spacing}

    def quantiles(self, shares: FloatArray) -> NDArray[Any]:
        """Return values between the ends."""
        low, high = self._ends
        between: FloatArray
        if self.spacing == "log":
            between = low ** (1.0 - shares) * high**shares
        else:
            between = low + (high - low) * shares
        return between

    def whole(self) -> Parameter:
        """Return the whole numbers of the range, where it has whole ends."""
        from bumpstop.study.whole import WholeRange

        return WholeRange(self) if self.is_whole else self

    @property
    def is_whole(self) -> bool:
        """Whether both ends are whole numbers."""
        return isinstance(self.start, int) and isinstance(self.end, int)

    @property
    def _ends(self) -> tuple[float, float]:
        return _number("from", self.start), _number("to", self.end)


_OWN_NAMES: dict[str, tuple[str, dict[str, str]]] = {
    "normal": ("norm", {"mean": "loc", "standard_deviation": "scale"}),
    "lognormal": ("lognorm", {"median": "scale", "sigma": "s"}),
}
"""Distributions by the words of engineers: what SciPy calls them, and their parameters."""


@dataclass(frozen=True, init=False)
class Distribution:
    """Values that chance spreads.

    Parameters
    ----------
    name
        ``"normal"`` with ``mean`` and ``standard_deviation``; ``"uniform"`` with ``low`` and
        ``high``; ``"lognormal"`` with ``median`` and ``sigma``, the standard deviation of the
        logarithm; or any distribution of `scipy.stats` by its name there.
    parameters
        Numbers in SI units, or texts with units; those of SciPy's own distributions by the
        names that it has for them, ``loc`` and ``scale`` among them.

    Raises
    ------
    InputError
        If there is no such distribution, or it has not these parameters.

    Examples
    --------
    >>> Distribution("normal", mean="1 mm", standard_deviation="0.1 mm").quantiles(np.array([0.5]))
    array([0.001])
    """

    name: str
    parameters: Mapping[str, float | str] = field(default_factory=dict)

    def __init__(self, name: str, /, **parameters: float | str) -> None:
        object.__setattr__(self, "name", name)
        plain = {key: _plain(value) for key, value in parameters.items()}
        object.__setattr__(self, "parameters", plain)
        self._frozen()
        sigma = plain.get("sigma")
        if name == "lognormal" and isinstance(sigma, str):
            with blamed("sigma"):
                read_quantity(sigma, _PURE)

    @property
    def levels(self) -> list[Level]:
        """There are none."""
        what = "a distribution has no values that could be listed"
        hint = "draw samples: latin_hypercube, sobol or monte_carlo"
        raise InputError(what, key="distribution", value=self.name, hint=hint)

    @property
    def written(self) -> tuple[object, ...]:
        """What is measured as the values are."""
        places = ("mean", "median", "low", "high", "loc")
        return tuple(self.parameters[key] for key in places if key in self.parameters)

    @property
    def spread(self) -> tuple[str, ...]:
        """What is measured as differences of the values are."""
        places = ("standard_deviation", "scale")
        given = (self.parameters.get(key) for key in places)
        return tuple(each for each in given if isinstance(each, str))

    @property
    def record(self) -> dict[str, Any]:
        """Name and parameters."""
        return {"distribution": self.name, **self.parameters}

    def quantiles(self, shares: FloatArray) -> NDArray[Any]:
        """Return the quantiles of the distribution."""
        found: FloatArray = self._frozen().ppf(np.clip(shares, _LEAST_SHARE, 1.0 - _LEAST_SHARE))
        return found

    def whole(self) -> Parameter:
        """Return the whole numbers that a discrete distribution draws."""
        from scipy import stats

        from bumpstop.study.whole import WholeDistribution

        discrete = isinstance(getattr(stats, self.name, None), stats.rv_discrete)
        return WholeDistribution(self) if discrete else self

    def _frozen(self) -> Any:
        """Return SciPy's distribution with its parameters."""
        from scipy import stats

        kinds = stats.rv_continuous | stats.rv_discrete
        known = [key for key, value in vars(stats).items() if isinstance(value, kinds)]
        one_of("distribution", self.name, (*_OWN_NAMES, *known))
        given = {key: _number(key, value) for key, value in self.parameters.items()}
        if self.name == "uniform" and not {"low", "high"}.isdisjoint(given):
            return _uniform(given)
        name, renamed = _OWN_NAMES.get(self.name, (self.name, {}))
        kind = getattr(stats, name)
        shapes = [part.strip() for part in (kind.shapes or "").split(",") if part.strip()]
        places = ["loc", "scale"] if isinstance(kind, stats.rv_continuous) else ["loc"]
        takes = list(renamed) or [*shapes, *places]
        for key in given:
            one_of("parameter", key, takes)
        for key in renamed or shapes:
            if key not in given:
                raise InputError("is missing", key=key, hint=f"{self.name} needs it")
        with np.errstate(all="ignore"):  # of parameters that are refused below
            frozen = kind(**{renamed.get(key, key): value for key, value in given.items()})
            median = frozen.ppf(0.5)
        if not np.isfinite(median):
            what = f"there is no {self.name} distribution with these parameters"
            raise InputError(what, value=dict(self.parameters))
        return frozen


def _uniform(given: Mapping[str, float]) -> Any:
    from scipy import stats

    for key in given:
        one_of("parameter", key, ("low", "high"))
    for key in ("low", "high"):
        if key not in given:
            raise InputError("is missing", key=key, hint="uniform needs it")
    if given["high"] <= given["low"]:
        raise InputError("must be above low", key="high", value=given["high"])
    return stats.uniform(given["low"], given["high"] - given["low"])


def as_parameter(value: object) -> Parameter:
    """Return a parameter that may also be given as a list or array of its values."""
    if isinstance(value, Values | Range | Distribution):
        return value
    if isinstance(value, np.ndarray):
        return Values(value.tolist())
    if isinstance(value, list | tuple | range):
        return Values(list(value))
    what = "must be a list of values, a Range or a Distribution"
    raise InputError(what, value=value)


def recorded_parameter(record: Mapping[str, Any]) -> Parameter:
    """Return the parameter that a record is of.

    >>> recorded_parameter(Range(1, 4, 2).record)
    Range(start=1, end=4, count=2, spacing='linear')
    """
    given = dict(record)
    takes_whole = given.pop("whole", False)
    known: Parameter
    if "values" in given:
        known = Values(given["values"])
    elif "distribution" in given:
        known = Distribution(given.pop("distribution"), **given)
    else:
        known = Range(given["from"], given["to"], given["count"], given["spacing"])
    return known.whole() if takes_whole else known


def _plain(value: Any) -> Any:
    """Return a number of numpy's as Python's own, everything else as it is."""
    return value.item() if isinstance(value, np.generic) else value


def _number(key: str, value: object) -> float:
    if isinstance(value, str):
        with blamed(key):
            return read_number_of_any_unit(value)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise InputError("must be a finite number", key=key, value=value)
    return float(value)


def _in_si(value: Level) -> Level:
    """Return a text that is a number with a unit as that number."""
    if not isinstance(value, str):
        return value
    try:
        return read_number_of_any_unit(value)
    except InputError:  # a word
        return value


def _are_numbers(levels: Sequence[Level]) -> bool:
    return not any(isinstance(level, str | bool) for level in levels)
