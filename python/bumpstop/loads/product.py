"""Product of functions of time: a wave under an envelope, a carrier and its modulation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from functools import lru_cache, partial

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError, blamed
from bumpstop.loads.sampling import TOLERANCE, checked_tolerance, sampled
from bumpstop.loads.time import (
    HIGHEST_DEGREE,
    Harmonic,
    Polynomial,
    Term,
    TimeFunction,
    TimeTable,
    resolved,
    scaled,
    time_functions,
)

__all__ = ["Product"]

_A_PERIOD = 8
"""Intervals a period of a harmonic between which the search for straight lines starts."""
_INTERVALS = 64


@dataclass(frozen=True, eq=False)
class Product:
    """The product of functions of time, or of sums of them.

    The exact method follows it without error where it is a sum of harmonics, polynomials and
    tables again: harmonics times harmonics, polynomials of degree five together, anything times
    a constant. Otherwise it follows straight lines through the product.

    Parameters
    ----------
    factors
        At least two, each a function of time or a list of functions whose sum is meant.
    tolerance
        Largest deviation of straight lines where such are needed, relative to the largest value
        in the run.

    Raises
    ------
    InputError
        If there are fewer factors, or something else is no function of time.

    Examples
    --------
    >>> beat = Product([Harmonic(50.0, cosine=1.0), Harmonic(2.0, cosine=1.0)])
    >>> [(term.frequency, term.cosine) for term in beat.terms(1.0)]
    [(52.0, 0.5), (48.0, 0.5)]
    """

    factors: Sequence[TimeFunction | Sequence[TimeFunction]]
    _: KW_ONLY
    tolerance: float = TOLERANCE

    def __post_init__(self) -> None:
        given = self.factors
        if not isinstance(given, list | tuple) or len(given) < 2:
            raise InputError("must be two functions of time or more", key="factors", value=given)
        sums = tuple(time_functions(factor, "factors") for factor in given)
        object.__setattr__(self, "factors", sums)
        object.__setattr__(self, "tolerance", checked_tolerance(self.tolerance))

    @property
    def sums(self) -> tuple[tuple[TimeFunction, ...], ...]:
        """The functions whose sum each factor is."""
        return self.factors  # type: ignore[return-value]  # tuples once they have been checked

    def at(self, times: FloatArray) -> FloatArray:
        """Return its values at some times in s."""
        return _at(self.sums, np.asarray(times, dtype=np.float64))

    @property
    def words(self) -> str:
        """What it is, in a few words."""
        return f"a product of {len(self.sums)} functions"

    @lru_cache(maxsize=16)  # noqa: B019  # asked for when a problem is made, and when it is run
    def terms(self, duration: float) -> tuple[Term, ...]:
        """Return the terms whose sum it is, or one table within its tolerance.

        Raises
        ------
        InputError
            If it takes more than two million lines.
        """
        with blamed("time.factors"):
            factors = [resolved(factor, duration) for factor in self.sums]
        exact: tuple[Term, ...] | None = factors[0]
        for factor in factors[1:]:
            exact = _multiplied(exact, factor)
        if exact is not None:
            return exact
        grid = _grid(factors, duration)
        product = partial(_at, factors)
        return (sampled(product, grid, self.tolerance, "time.factors"),)


def _at(factors: Sequence[Sequence[TimeFunction]], times: FloatArray) -> FloatArray:
    values = np.ones(times.shape)
    for factor in factors:
        values = values * sum(function.at(times) for function in factor)
    return values


def _multiplied(one: tuple[Term, ...] | None, other: tuple[Term, ...]) -> tuple[Term, ...] | None:
    """Return the product of two sums as a sum of terms; None where it is none."""
    if one is None:
        return None
    products = [_product(first, second) for first in one for second in other]
    terms = [term for product in products if product is not None for term in product]
    return None if None in products else tuple(terms)


def _product(one: Term, other: Term) -> tuple[Term, ...] | None:
    for constant, function in ((one, other), (other, one)):
        if isinstance(constant, Polynomial) and len(constant.coefficients) == 1:
            term = scaled(function, constant.coefficients[0])
            return term.terms(0.0)
    if isinstance(one, Polynomial) and isinstance(other, Polynomial):
        coefficients = np.convolve(one.coefficients, other.coefficients)
        return (Polynomial(coefficients),) if len(coefficients) <= HIGHEST_DEGREE + 1 else None
    if isinstance(one, Harmonic) and isinstance(other, Harmonic):
        return _beat(one, other)
    return None


def _beat(one: Harmonic, other: Harmonic) -> tuple[Term, ...]:
    """Return the oscillations with the sum and the difference of two frequencies."""
    if one.frequency < other.frequency:
        one, other = other, one
    both, crossed = one.cosine * other.cosine, one.sine * other.cosine
    sines, turned = one.sine * other.sine, one.cosine * other.sine
    high = Harmonic(
        one.frequency + other.frequency,
        cosine=0.5 * (both - sines),
        sine=0.5 * (crossed + turned),
    )
    difference = one.frequency - other.frequency
    cosine, sine = 0.5 * (both + sines), 0.5 * (crossed - turned)
    if difference == 0.0:
        return (high, Polynomial([cosine]))
    return (high, Harmonic(difference, cosine=cosine, sine=sine))


def _grid(factors: Sequence[Sequence[Term]], duration: float) -> FloatArray:
    """Return times with all knots of tables, finer than the shortest period."""
    terms = [term for factor in factors for term in factor]
    knots = [np.asarray(term.times) for term in terms if isinstance(term, TimeTable)]
    quick = sum(
        max((term.frequency for term in factor if isinstance(term, Harmonic)), default=0.0)
        for factor in factors
    )
    even = np.linspace(0.0, duration, _INTERVALS + int(_A_PERIOD * quick * duration) + 1)
    times = np.unique(np.concatenate([even, *knots]))
    return times[(times >= 0.0) & (times <= duration)]
