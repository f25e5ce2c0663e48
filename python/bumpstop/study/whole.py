"""Parameters of keys that take whole numbers alone, such as a number of modes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.study.parameters import Distribution, Level, Range

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["WholeDistribution", "WholeRange"]


@dataclass(frozen=True)
class _Whole:
    """A parameter, as a key that takes whole numbers alone draws it."""

    inner: Range | Distribution

    @property
    def written(self) -> tuple[object, ...]:
        """Values as they are written."""
        return self.inner.written

    @property
    def spread(self) -> tuple[str, ...]:
        """Texts of differences of values."""
        return self.inner.spread

    @property
    def record(self) -> dict[str, Any]:
        """What it is, and that it is drawn so."""
        return {**self.inner.record, "whole": True}

    @property
    def levels(self) -> list[Level]:
        """The values on a grid; equal ratios are rounded."""
        levels = [round(float(level)) for level in self.inner.levels]
        if len(set(levels)) < len(levels):
            what = "makes the same whole number more than once"
            raise InputError(what, key="count", value=len(levels), hint="take fewer")
        return [*levels]

    def whole(self) -> Self:
        """Return itself."""
        return self


@dataclass(frozen=True)
class WholeRange(_Whole):
    """The whole numbers from one to another, both included."""

    inner: Range

    def quantiles(self, shares: FloatArray) -> NDArray[Any]:
        """Return whole numbers, each as often as the others, or by their logarithms."""
        low, high = int(self.inner.start), int(self.inner.end)
        drawn: NDArray[np.int64]
        if self.inner.spacing == "log":
            drawn = np.rint(self.inner.quantiles(shares)).astype(np.int64)
        else:
            steps = np.minimum(np.floor(shares * (abs(high - low) + 1)), abs(high - low))
            drawn = (low + np.sign(high - low) * steps).astype(np.int64)
        return drawn


@dataclass(frozen=True)
class WholeDistribution(_Whole):
    """A discrete distribution of SciPy, whose quantiles are whole numbers."""

    inner: Distribution

    def quantiles(self, shares: FloatArray) -> NDArray[Any]:
        """Return the quantiles of the distribution."""
        drawn: NDArray[np.int64] = np.rint(self.inner.quantiles(shares)).astype(np.int64)
        return drawn
