"""What a result is, and what it finds in a run."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple, Protocol

from bumpstop.arguments import one_of
from bumpstop.errors import BumpstopError, InputError
from bumpstop.quantities import Quantity

if TYPE_CHECKING:
    import xarray as xr

    from bumpstop.problem import Problem
    from bumpstop.response import Response

__all__ = [
    "Drawn",
    "Fact",
    "Reading",
    "Result",
    "check_period",
    "check_span",
    "check_step",
    "check_stop",
    "read_result",
]


class Fact(NamedTuple):
    """A number that a result tells."""

    what: Quantity
    value: float
    uncertainty: float = math.nan
    """Standard error, where there is one."""


class Drawn(NamedTuple):
    """An array to be drawn, and which of its axes are logarithmic."""

    array: xr.DataArray
    log: str = ""


class Reading(NamedTuple):
    """What a result found in a run."""

    facts: Sequence[Fact] = ()
    figures: Sequence[Drawn] = ()
    missing: str = ""
    """Why nothing was found, in a line; empty where something was."""


class Result(Protocol):
    """Something to be read out of a run."""

    @property
    def name(self) -> str:
        """What it is called."""

    def check(self, problem: Problem) -> None:
        """Raise InputError where a problem does not have what it is about."""

    def read(self, response: Response) -> Reading:
        """Read it out of a run."""


def read_result(result: Result, response: Response) -> Reading:
    """Read a result out of a run, once; where that fails, the run and its other results stand."""
    known = response.known_readings.get(result.name)
    if known is None or known[0] is not result:
        known = response.known_readings[result.name] = result, _read(result, response)
    return known[1]


def _read(result: Result, response: Response) -> Reading:
    try:
        return result.read(response)
    except BumpstopError as error:
        return Reading(missing=f"results.{result.name}: {error}")
    except Exception as error:
        told = f"this is a mistake in bumpstop itself: {type(error).__name__}: {error}"
        return Reading(missing=f"results.{result.name}: {told}")


def check_period(period: float, start: float, problem: Problem) -> None:
    """Raise where not two periods of a clock that starts with the run are between two times."""
    first, last = math.ceil(start / period - 1e-9), math.floor(problem.duration / period + 1e-9)
    if last - first < 2:
        what = (
            f"does not fit twice between the start and the end of the run, {problem.duration:g} s"
        )
        raise InputError(what, key="period", value=period)


def check_step(step: float, start: float, end: float | None, problem: Problem) -> None:
    """Raise where samples with a step are fewer than two."""
    last = problem.duration if end is None else end
    if start + step > last * (1.0 + 1e-9):
        what = f"must be below the {last - start:g} s that are sampled"
        raise InputError(what, key="sample", value=step)


def check_stop(stop: str, problem: Problem) -> None:
    """Raise where a problem has no such stop."""
    one_of("stop", stop, problem.stop_names)


def check_span(start: float, end: float | None, problem: Problem) -> None:
    """Raise where a stretch of time is not within the run."""
    last = problem.duration if end is None else end
    if not 0.0 <= start < last <= problem.duration:
        key, value = ("start", start) if end is None else ("end", end)
        what = f"must be within the run of {problem.duration:g} s, the start before the end"
        raise InputError(what, key=key, value=value)
