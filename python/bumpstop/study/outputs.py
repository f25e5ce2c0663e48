"""What is kept of each run: values at instants, statistics over time or impacts, counts."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.arguments import FloatArray, count, one_of, series
from bumpstop.errors import InputError
from bumpstop.post.impacts import impacts_of
from bumpstop.post.references import IMPACT_COLUMNS, REFERENCE_QUANTITIES, Reference, computed
from bumpstop.quantities import QUANTITIES, STATISTICS, Quantity

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Problem
    from bumpstop.response import Response

__all__ = ["OUTPUT_QUANTITIES", "OUTPUT_STATISTICS", "Output"]

_OF_RUN: dict[str, tuple[Quantity, Callable[[Response], float]]] = {
    "impacts": (
        Quantity("1", "number of impacts on all stops"),
        lambda response: len(response.impact_table()["start"]),
    ),
    "events": (
        Quantity("1", "how many times a law switched"),
        lambda response: response.event_count,
    ),
    "steps": (Quantity("1", "steps of the method"), lambda response: response.steps),
    "energy_residual": (
        Quantity("1", "largest imbalance of energy, relative to the largest energy"),
        lambda response: response.energy_residual,
    ),
    "motion_error": (
        Quantity("m", "bound of the motion's error by rounding"),
        lambda response: _or_nan(response.motion_error),
    ),
    "missed_penetration": (
        Quantity("m", "bound of the depth of contacts that were missed"),
        lambda response: _or_nan(response.missed_penetration),
    ),
}
"""Quantities of a whole run, and how a response tells them."""

OUTPUT_QUANTITIES = (*_OF_RUN, *REFERENCE_QUANTITIES)

OUTPUT_STATISTICS = ("maximum", "minimum", "peak", "mean", "rms", "last")
"""What can be kept of a quantity of time, or of all impacts of a stop."""

_CLOSER = 16
"""How much closer each look at an extreme value goes."""
_LOOKS = 5


MOST_LATEST = 1_000_000
"""Impacts of a run that are kept one by one."""


@dataclass(frozen=True, kw_only=True)
class Output:
    """A number, or numbers at given instants, that a study keeps of each run.

    Parameters
    ----------
    quantity
        What to keep. Of the whole run: ``impacts`` (how many on all stops), ``events``,
        ``steps``, ``energy_residual``, ``motion_error``, ``missed_penetration``. Else all that
        a `Reference` may be of: ``displacement``, ``stop_force`` and other quantities of time;
        ``peak_force``, ``closing_speed`` and others of an impact; the contact statistics of a
        stop, such as ``largest_force``; the natural ``frequency`` of a mode.
    node, dof, mode, stop, gauge, term, impact
        What it is the quantity of. Modes and impacts count from 1.
    statistic
        Of a quantity of time, over the run: ``maximum``, ``minimum``, ``peak`` (the largest
        magnitude), ``mean``, ``rms`` or ``last``. Extreme values are looked for between the
        samples next to the most extreme one; ``mean`` and ``rms`` are those of the samples.
        Of a quantity of impacts, over all of the stop: the same words.
    times
        Instead of a statistic: the instants in s at which a quantity of time is kept.
    latest
        Instead of a statistic: of how many impacts, the last of the run, a quantity of impacts
        is kept, such as the closing speeds of a bifurcation diagram; NaN in front where there
        are fewer.

    Raises
    ------
    InputError
        If the quantity is unknown, or what it needs is missing.
    """

    quantity: str
    node: str | None = None
    dof: str | None = None
    mode: int | None = None
    stop: str | None = None
    gauge: str | None = None
    term: str | None = None
    impact: int | None = None
    statistic: str | None = None
    times: Sequence[float] = ()
    latest: int | None = None

    def __post_init__(self) -> None:
        one_of("quantity", self.quantity, OUTPUT_QUANTITIES)
        object.__setattr__(self, "times", series("times", self.times) if len(self.times) else ())
        if self.statistic is not None:
            one_of("statistic", self.statistic, OUTPUT_STATISTICS)
        if self.latest is not None:
            self._check_latest()
        self._check_statistic()
        if self.quantity not in _OF_RUN:
            _ = self.target
        elif any(value is not None for value in self._places.values()):
            hint = "it is that of the whole run"
            raise InputError(f"{self.quantity} has no node, stop or part", hint=hint)

    @property
    def shape(self) -> tuple[int, ...]:
        """How many numbers it is: one, or one an instant, or one an impact."""
        if self.latest is not None:
            return (self.latest,)
        return (len(self.times),) if self.times else ()

    @property
    def dimension(self) -> str:
        """What its numbers are over, where it has several: ``time`` or ``impact``."""
        return "time" if self.latest is None else "impact"

    @property
    def attributes(self) -> dict[str, str]:
        """Unit and words, as attributes of an array."""
        if self.quantity in _OF_RUN:
            return _OF_RUN[self.quantity][0].attributes
        words = [self.statistic, self.quantity.replace("_", " "), "of" if self._named else None]
        told = " ".join(str(word) for word in [*words, *self._named] if word)
        return {"units": self.target.units, "long_name": told}

    @property
    def record(self) -> dict[str, Any]:
        """What it is, for a study to be known again by."""
        places = {key: value for key, value in self._places.items() if value is not None}
        extra: dict[str, Any] = {"times": list(self.times)}
        if self.statistic:
            extra = {"statistic": self.statistic}
        elif self.latest is not None:
            extra = {"latest": self.latest}
        return {"quantity": self.quantity, **places, **extra}

    @cached_property
    def target(self) -> Reference:
        """What a reference of this quantity is of; its values mean nothing."""
        places = dict(self._places)
        if self._is_of_impacts and places["impact"] is None:
            places["impact"] = 1
        times = self.times or ((0.0,) if self._is_of_time else ())
        return Reference(
            quantity=self.quantity,
            values=[0.0] * max(len(times), 1),
            times=times,
            absolute_tolerance=1.0,
            **places,
        )

    def check(self, problem: Problem) -> None:
        """Raise where a problem has no such node, stop or gauge, or ends earlier."""
        if self.quantity not in _OF_RUN:
            self.target.check_target(problem)

    def of_modes(self, basis: ModalBasis) -> float:
        """Return the natural frequency of the mode, in Hz; the only thing that modes tell.

        Raises
        ------
        InputError
            If it is something else, or the basis has no such mode.
        """
        if self.quantity != "frequency":
            hint = "without [run] there are frequencies alone"
            raise InputError("is never computed", key="quantity", value=self.quantity, hint=hint)
        self.target.check_modes(basis)
        return float(basis.frequencies[(self.mode or 1) - 1])

    def value(self, response: Response) -> float | FloatArray:
        """Return what is kept of a response: a number, or an array (time,)."""
        if self.quantity in _OF_RUN:
            return float(_OF_RUN[self.quantity][1](response))
        if self.quantity == "frequency":
            return self.of_modes(response.problem.basis)
        if self.statistic is not None and self._is_of_impacts:
            table = impacts_of(response, response.law_index(str(self.stop)))
            return _of_impacts(self.statistic, table[IMPACT_COLUMNS[self.quantity]])
        if self.statistic is not None:
            return _over_time(self.statistic, self._sampled(response), response.times)
        if self.latest is not None:
            table = impacts_of(response, response.law_index(str(self.stop)))
            column = table[IMPACT_COLUMNS[self.quantity]][-self.latest :]
            return np.concatenate([np.full(self.latest - len(column), np.nan), column])
        values = computed(response, self.target)[1]
        return values if self.times else float(values[0])

    @property
    def _places(self) -> dict[str, Any]:
        keys = ("node", "dof", "mode", "stop", "gauge", "term", "impact")
        return {key: getattr(self, key) for key in keys}

    @property
    def _named(self) -> list[str]:
        return [str(value) for value in self._places.values() if value is not None]

    @property
    def _is_of_impacts(self) -> bool:
        return self.quantity in IMPACT_COLUMNS

    @property
    def _is_of_time(self) -> bool:
        return self.quantity in QUANTITIES or self.quantity == "energy"

    def _check_statistic(self) -> None:
        many = self._is_of_time or (self._is_of_impacts and self.impact is None)
        if many and self.statistic is None and not self.times and self.latest is None:
            what = f"is needed for {self.quantity}: it has many values"
            hint = "or give times" if self._is_of_time else "or the number of an impact"
            raise InputError(what, key="statistic", hint=hint)
        if self.statistic is not None and (self.times or not many):
            what = f"does not belong to one value of {self.quantity}"
            if self.times:
                what = "times are given, of which each value is kept"
            raise InputError(what, key="statistic", value=self.statistic)
        if self.quantity in STATISTICS and self.times:
            raise InputError("is one value of the whole run", key="times", value=self.times)

    def _check_latest(self) -> None:
        count("latest", self.latest, most=MOST_LATEST)
        if not self._is_of_impacts:
            what = "belongs to quantities of impacts"
            raise InputError(what, key="latest", value=self.quantity)
        if self.impact is not None or self.statistic is not None or self.times:
            hint = "give either latest, or the number of one impact or a statistic"
            raise InputError("is one of several ways to choose impacts", key="latest", hint=hint)

    def _sampled(self, response: Response) -> Callable[[FloatArray], FloatArray]:
        """Return the quantity as a function of instants."""
        if self.quantity == "energy":
            return lambda times: response.energy_terms(times)[str(self.term)]
        return lambda times: response.sample(*self.target.target, times=times)


def _over_time(
    statistic: str, function: Callable[[FloatArray], FloatArray], times: FloatArray
) -> float:
    """Return a statistic of a function of time over the run."""
    if statistic == "last":
        return float(function(times[-1:])[0])
    if statistic == "maximum":
        return _largest(function, times)
    if statistic == "minimum":
        return -_largest(lambda instants: -function(instants), times)
    if statistic == "peak":
        return _largest(lambda instants: np.abs(function(instants)), times)
    values = function(times)
    span = times[-1] - times[0]
    if statistic == "mean":
        return float(np.trapezoid(values, times) / span)
    return math.sqrt(float(np.trapezoid(values**2, times)) / span)


def _largest(function: Callable[[FloatArray], FloatArray], times: FloatArray) -> float:
    """Return the largest value, found ever closer about the largest sample."""
    values = function(times)
    largest = values.max()
    for _ in range(_LOOKS):
        best = int(np.argmax(values))
        low, high = times[max(best - 1, 0)], times[min(best + 1, len(times) - 1)]
        times = np.linspace(low, high, 2 * _CLOSER + 1)
        values = function(times)
        largest = max(largest, values.max())
    return float(largest)


def _of_impacts(statistic: str, column: FloatArray) -> float:
    """Return a statistic over impacts; NaN where there is none."""
    values = column[~np.isnan(column)]
    if not len(values):
        return math.nan
    return float(_OF_MANY[statistic](values))


_OF_MANY: dict[str, Callable[[FloatArray], float]] = {
    "maximum": lambda values: values.max(),
    "minimum": lambda values: values.min(),
    "peak": lambda values: np.abs(values).max(),
    "mean": lambda values: values.mean(),
    "rms": lambda values: math.sqrt(np.mean(values**2)),
    "last": lambda values: values[-1],
}


def _or_nan(value: float | None) -> float:
    return math.nan if value is None else value
