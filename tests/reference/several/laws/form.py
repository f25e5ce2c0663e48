"""Linear functions of a law's local motion, in floats or in decimals."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from decimal import Decimal
from typing import Generic, TypeVar

T = TypeVar("T", float, Decimal)

Place = tuple[int, int]
"""A local coordinate, and which of its derivatives."""


@dataclass(frozen=True)
class Form(Generic[T]):
    """``constant + memory m + sum of factor * derivative`` of the local coordinates."""

    constant: T
    memory: T
    factors: Mapping[Place, T] = field(default_factory=dict)

    @classmethod
    def coordinate(cls, number: int, one: T) -> "Form[T]":
        """Return a local coordinate, in the kind of number that ``one`` is."""
        return cls(one - one, one - one, {(number, 0): one})

    @classmethod
    def remembered(cls, one: T) -> "Form[T]":
        """Return what the law remembers."""
        return cls(one - one, one)

    def __add__(self, other: "Form[T]") -> "Form[T]":
        """Add two functions."""
        factors = dict(self.factors)
        for place, factor in other.factors.items():
            factors[place] = factors[place] + factor if place in factors else factor
        return Form(self.constant + other.constant, self.memory + other.memory, factors)

    def __mul__(self, factor: T) -> "Form[T]":
        """Multiply by a number."""
        factors = {place: factor * value for place, value in self.factors.items()}
        return Form(factor * self.constant, factor * self.memory, factors)

    def __neg__(self) -> "Form[T]":
        """Change the sign."""
        factors = {place: -value for place, value in self.factors.items()}
        return Form(-self.constant, -self.memory, factors)

    def __sub__(self, other: "Form[T]") -> "Form[T]":
        """Subtract a function."""
        return self + -other

    def plus(self, constant: T) -> "Form[T]":
        """Add a constant."""
        return Form(self.constant + constant, self.memory, self.factors)

    def rate(self) -> "Form[T]":
        """Return the derivative in time; what is remembered stays."""
        none = self.constant - self.constant
        factors = {(which, order + 1): value for (which, order), value in self.factors.items()}
        return Form(none, none, factors)
