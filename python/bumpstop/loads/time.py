"""Functions of time that loads are multiplied by, and those that the core follows exactly.

The core follows *terms*: harmonics, polynomials, and tables with straight lines. Every other
function says of which terms it is the sum over a run (`TimeFunction.terms`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, field
from typing import Protocol, Self, TypeAlias, runtime_checkable

import numpy as np

from bumpstop.arguments import FloatArray, finite, one_of, positive, series
from bumpstop.errors import InputError

__all__ = [
    "Harmonic",
    "Polynomial",
    "Term",
    "TimeFunction",
    "TimeTable",
    "check_span",
    "check_steady",
    "resolved",
    "scaled",
    "time_functions",
]

HIGHEST_DEGREE = 5
"""Of a polynomial that the core follows."""

BEYOND = ("zero", "hold")


@runtime_checkable
class TimeFunction(Protocol):
    """A function of time."""

    @property
    def words(self) -> str:
        """What it is, in a few words."""

    def at(self, times: FloatArray) -> FloatArray:
        """Return its values at some times in s from the start of the run."""

    def terms(self, duration: float) -> tuple[Term, ...]:
        """Return the terms whose sum it is, or is to its tolerance, from 0 to a duration in s."""


class _Term:
    """A function that the core follows as it is."""

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        return type(self).__name__.lower()

    def terms(self, duration: float) -> tuple[Self, ...]:  # noqa: ARG002  # the same for any
        """Return the function itself."""
        return (self,)


@dataclass(frozen=True)
class Harmonic(_Term):
    """An oscillation, ``cosine cos(2 pi f t) + sine sin(2 pi f t)``, t from the start of the run.

    Parameters
    ----------
    frequency
        Its frequency f in Hz.
    cosine, sine
        Its amplitudes.

    Raises
    ------
    InputError
        If the frequency is not positive or a number not finite.

    Examples
    --------
    >>> Harmonic(12.0, sine=1.0)
    Harmonic(frequency=12.0, cosine=0.0, sine=1.0)
    """

    frequency: float
    _: KW_ONLY
    cosine: float = 0.0
    sine: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "frequency", positive("frequency", self.frequency))
        for key in ("cosine", "sine"):
            object.__setattr__(self, key, finite(key, getattr(self, key)))

    @classmethod
    def with_phase(
        cls, frequency: float, *, amplitude: float = 1.0, phase: float = 0.0
    ) -> Harmonic:
        """Return ``amplitude cos(2 pi f t + phase)``, the phase in radians.

        Examples
        --------
        >>> Harmonic.with_phase(3.0, amplitude=2.0)
        Harmonic(frequency=3.0, cosine=2.0, sine=-0.0)
        """
        size, angle = finite("amplitude", amplitude), finite("phase", phase)
        return cls(frequency, cosine=size * math.cos(angle), sine=-size * math.sin(angle))

    def at(self, times: FloatArray) -> FloatArray:
        """Return its values at some times in s."""
        angle = 2.0 * math.pi * self.frequency * np.asarray(times, dtype=np.float64)
        values: FloatArray = self.cosine * np.cos(angle) + self.sine * np.sin(angle)
        return values


@dataclass(frozen=True)
class Polynomial(_Term):
    """A polynomial ``c[0] + c[1] t + c[2] t^2 + ...``, t in s from the start of the run.

    Parameters
    ----------
    coefficients
        Those of the powers of t, the constant first; of degree 5 at most.

    Raises
    ------
    InputError
        If there is none, one is not finite, or the degree is higher.

    Examples
    --------
    >>> Polynomial([0.0, 2.0]).at(np.array([0.5]))
    array([1.])
    """

    coefficients: Sequence[float] | FloatArray

    def __post_init__(self) -> None:
        coefficients = series("coefficients", self.coefficients)
        if len(coefficients) > HIGHEST_DEGREE + 1:
            hint = "give a table with straight lines instead"
            what = f"must be of degree {HIGHEST_DEGREE} at most"
            value = f"{len(coefficients)} coefficients"
            raise InputError(what, key="coefficients", value=value, hint=hint)
        object.__setattr__(self, "coefficients", coefficients)

    def at(self, times: FloatArray) -> FloatArray:
        """Return its values at some times in s."""
        values: FloatArray = np.polynomial.polynomial.polyval(times, np.array(self.coefficients))
        return values


@dataclass(frozen=True, eq=False)
class TimeTable(_Term):
    """Straight lines between given values, such as an accelerogram.

    Two equal times are a jump; at that instant the second value holds. The exact method follows
    such a table without error, each line as a phase of its own.

    Parameters
    ----------
    times
        Times (K,) in s from the start of the run, in ascending order.
    values
        What the function is there (K,).
    beyond
        What it is before the first time and after the last: ``"zero"``, or ``"hold"`` for the
        nearest value. Where it is left out the table must cover the whole run.

    Raises
    ------
    InputError
        If the lists differ in length, a number is not finite, or times go backwards.

    Examples
    --------
    >>> pulse = TimeTable([0.0, 0.1, 0.2], [0.0, 1.0, 0.0], beyond="zero")
    >>> pulse.at(np.array([0.05, 3.0]))
    array([0.5, 0. ])
    """

    times: Sequence[float] | FloatArray = field(repr=False)
    values: Sequence[float] | FloatArray = field(repr=False)
    _: KW_ONLY
    beyond: str | None = None

    def __post_init__(self) -> None:
        for key in ("times", "values"):
            object.__setattr__(self, key, _column(key, getattr(self, key)))
        if len(self.times) != len(self.values):
            numbers = f"{len(self.values)} values, {len(self.times)} times"
            raise InputError("must have one value for each time", key="values", value=numbers)
        backwards = np.flatnonzero(np.diff(self.times) < 0.0)
        if len(backwards):
            at = int(backwards[0]) + 1
            hint = f"entry {at + 1} is earlier than the one before it"
            earlier = float(self.times[at])
            raise InputError("must not go backwards", key="times", value=earlier, hint=hint)
        if self.beyond is not None:
            one_of("beyond", self.beyond, BEYOND)

    def at(self, times: FloatArray) -> FloatArray:
        """Return its values at some times in s."""
        knots, values = np.asarray(self.times), np.asarray(self.values)
        wanted = np.asarray(times, dtype=np.float64)
        place = np.searchsorted(knots, wanted, side="right")
        before, after = np.maximum(place - 1, 0), np.minimum(place, len(knots) - 1)
        width = knots[after] - knots[before]
        part = np.divide(
            wanted - knots[before], width, where=width > 0.0, out=np.zeros_like(wanted)
        )
        found: FloatArray = values[before] + part * (values[after] - values[before])
        if self.beyond == "hold":
            return found
        return np.where((place == 0) | (place == len(knots)), 0.0, found)


Term: TypeAlias = Harmonic | Polynomial | TimeTable
"""What the core follows without error."""


def resolved(functions: Sequence[TimeFunction], duration: float) -> tuple[Term, ...]:
    """Return the terms whose sum some functions are over a run.

    Raises
    ------
    InputError
        If a function cannot be told by terms, or a table does not cover the run.
    """
    terms = tuple(term for function in functions for term in function.terms(duration))
    check_span(terms, duration)
    return terms


def time_functions(value: object, key: str = "time") -> tuple[TimeFunction, ...]:
    """Return the functions that a load is multiplied by the sum of; none where it is constant.

    Raises
    ------
    InputError
        If it is neither such a function nor a list of them.
    """
    if value is None:
        return ()
    given = value if isinstance(value, list | tuple) else (value,)
    for each in given:
        if not isinstance(each, TimeFunction):
            what = "must be a Harmonic, a Polynomial, a TimeTable, another function of time, "
            what += "or a list of them"
            raise InputError(what, key=key, value=each)
    if not given:
        raise InputError("must not be empty", key=key, value=value, hint="leave it out")
    return tuple(given)


def check_span(functions: Sequence[Term], duration: float, key: str = "time") -> None:
    """Refuse a table that does not cover the run and does not say what it is beyond its ends.

    Raises
    ------
    InputError
        If there is such a table.
    """
    for table in functions:
        if not isinstance(table, TimeTable) or table.beyond is not None:
            continue
        first, last = float(table.times[0]), float(table.times[-1])
        if first > 0.0 or last < duration:
            what = "does not cover the run, and does not say what it is beyond its ends"
            value = f"{first:g} s to {last:g} s, run 0 to {duration:g} s"
            hint = 'beyond = "zero" or "hold"'
            raise InputError(what, key=key, value=value, hint=hint)


def check_steady(functions: Sequence[Term], key: str) -> None:
    """Refuse a table that jumps, within its times or at its ends.

    Raises
    ------
    InputError
        If there is such a table.
    """
    for table in functions:
        if not isinstance(table, TimeTable):
            continue
        times, values = np.asarray(table.times), np.asarray(table.values)
        jumps = times[:-1][(np.diff(times) == 0.0) & (np.diff(values) != 0.0)].tolist()
        if table.beyond == "zero":
            jumps += [float(times[end]) for end in (0, -1) if values[end] != 0.0]
        if jumps:
            what = "must not jump: an obstacle moves at a finite speed"
            hint = 'leave a little time between its values; beyond = "hold" keeps the last one'
            raise InputError(what, key=key, value=f"jump at {jumps[0]:g} s", hint=hint)


def scaled(function: TimeFunction, factor: float) -> TimeFunction:
    """Return a function of time times a factor.

    Examples
    --------
    >>> scaled(Polynomial([0.0, 2.0]), 0.5)
    Polynomial(coefficients=(0.0, 1.0))
    """
    if isinstance(function, Harmonic):
        cosine, sine = factor * function.cosine, factor * function.sine
        return Harmonic(function.frequency, cosine=cosine, sine=sine)
    if isinstance(function, Polynomial):
        return Polynomial([factor * c for c in function.coefficients])
    if isinstance(function, TimeTable):
        values = factor * np.asarray(function.values)
        return TimeTable(function.times, values, beyond=function.beyond)
    from bumpstop.loads.product import Product

    return Product([Polynomial([factor]), function])


def _column(key: str, value: object) -> FloatArray:
    """Return a list of numbers as an array, which costs nothing for one that is such."""
    if isinstance(value, np.ndarray) and value.ndim == 1 and value.dtype.kind in "iuf":
        numbers = value.astype(np.float64)
        if not len(numbers):
            raise InputError("must be a list of numbers", key=key, value="none")
    else:
        numbers = np.array(series(key, value))
    wrong = np.flatnonzero(~np.isfinite(numbers))
    if len(wrong):
        at = int(wrong[0])
        hint = f"entry {at + 1} of {len(numbers)}"
        raise InputError("must be finite", key=key, value=float(numbers[at]), hint=hint)
    numbers.flags.writeable = False
    return numbers
