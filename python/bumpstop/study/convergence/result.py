"""What a study of convergence finds."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray
from bumpstop.study.convergence.published import Position, position_of

if TYPE_CHECKING:
    import pandas as pd

    from bumpstop.io.case import Case
    from bumpstop.post.references import Check
    from bumpstop.response import Response

__all__ = ["PARTS", "Convergence", "Ladder", "Rung", "VariantConvergence"]

PARTS = ("time", "basis", "mesh")
"""Where errors come from, in the order in which they are taken off."""


class Rung(NamedTuple):
    """The reference quantities, computed with one size of the model."""

    label: str
    """What its size is, in words: ``20 modes``."""
    size: float
    """Steps a second, vectors of the basis, or elements in the place of one."""
    values: FloatArray
    """One a published value, (n,)."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Ladder:
    """One source of error, found by refinement.

    Parameters
    ----------
    part
        ``time``, ``basis`` or ``mesh``.
    rungs
        What was computed, coarsest first; none where nothing was refined.
    error
        Computed less converged values, (n,); NaN where it is not known.
    uncertainty
        How far the error may be from that, (n,).
    order
        At which the error shrinks, (n,): with the step, the number of vectors, or the elements'
        size; NaN where the sequence is not regular or too short to tell.
    told
        What was done, or why nothing, in words.
    start
        Which rung has the size of the case.
    """

    part: str
    rungs: tuple[Rung, ...] = ()
    error: FloatArray
    uncertainty: FloatArray
    order: FloatArray
    told: str
    start: int = 0

    @property
    def limits(self) -> FloatArray:
        """What the rungs lead to, (n,)."""
        limits: FloatArray = self.rungs[self.start].values - self.error
        return limits


@dataclass(frozen=True, eq=False, kw_only=True)
class VariantConvergence:
    """One variant: its published values, computed values, and the errors of these.

    Parameters
    ----------
    name
        Of the variant.
    vectors
        How many its basis has.
    response
        Its response, as the case says; None for a case about modes alone.
    checks
        Computed beside published values.
    time, basis, mesh
        The three sources of error.
    remedy
        The same basis with the static shapes of its stops, where it has none.
    """

    name: str
    vectors: int
    response: Response | None
    checks: list[Check]
    time: Ladder
    basis: Ladder
    mesh: Ladder
    remedy: Ladder | None

    @property
    def ladders(self) -> tuple[Ladder, Ladder, Ladder]:
        """Time, basis and mesh."""
        return self.time, self.basis, self.mesh

    @cached_property
    def computed(self) -> FloatArray:
        """Values of the case as it is, (n,)."""
        return np.array([check.value for check in self.checks])

    @cached_property
    def published(self) -> FloatArray:
        """Published values, (n,)."""
        return np.array([check.reference for check in self.checks])

    @cached_property
    def allowed(self) -> FloatArray:
        """How far a value may be from the published one, in its own unit, (n,)."""
        return np.array(
            [
                check.tolerance * (1.0 if check.absolute else abs(check.reference))
                for check in self.checks
            ]
        )

    @cached_property
    def error(self) -> FloatArray:
        """Computed less converged values, of all sources that are known, (n,)."""
        return _summed([ladder.error for ladder in self.ladders], len(self.checks))

    @cached_property
    def converged(self) -> FloatArray:
        """Values that refinement leads to, (n,)."""
        converged: FloatArray = self.computed - self.error
        return converged

    @cached_property
    def uncertainty(self) -> FloatArray:
        """How far the converged values may be from these, (n,)."""
        return _summed([ladder.uncertainty for ladder in self.ladders], len(self.checks))

    @cached_property
    def position(self) -> Position | None:
        """Where the published values lie, between the computed and the converged ones.

        Those that were computed with this very model do not count.
        """
        values = (self.published, self.computed, self.converged, self.allowed, self.uncertainty)
        return position_of(*(each[self.outside] for each in values))

    @cached_property
    def outside(self) -> NDArray[np.bool_]:
        """Which published values were not computed with this very model, (n,)."""
        return np.array([not check.of_model for check in self.checks], dtype=bool)

    @property
    def distances(self) -> tuple[float, float]:
        """How far the values from outside are from the computed and from the converged ones.

        Both as `relative` has them; zero where there are none.
        """
        ends = (self.computed, self.converged)
        computed, converged = (
            self.relative(np.where(self.outside, end - self.published, np.nan)) for end in ends
        )
        return computed, converged

    @property
    def largest(self) -> str:
        """The source of most of the error: ``time``, ``basis`` or ``mesh``."""
        sizes = {each.part: self.relative(each.error) for each in self.ladders}
        return max(sizes, key=lambda part: sizes[part])

    def relative(self, errors: FloatArray) -> float:
        """Return the root mean square of errors, relative to that of the published values.

        Each quantity is taken by itself first; errors that are not known do not count.
        """
        targets = [check.target for check in self.checks]
        scale = np.array([self._size(targets.index(target)) for target in targets])
        usable = np.isfinite(errors) & (scale > 0.0)
        if not usable.any():
            return 0.0
        return float(np.sqrt(np.mean((errors[usable] / scale[usable]) ** 2)))

    def _size(self, first: int) -> float:
        """Return the root mean square of the published values of one quantity."""
        target = self.checks[first].target
        values = [check.reference for check in self.checks if check.target == target]
        return float(np.sqrt(np.mean(np.square(values))))


@dataclass(frozen=True, eq=False)
class Convergence:
    """How wrong the results of a case are, variant by variant.

    Parameters
    ----------
    case
        The case.
    variants
        What was found of each.
    """

    case: Case
    variants: dict[str, VariantConvergence]

    @property
    def table(self) -> pd.DataFrame:
        """A row for each published value.

        Columns: ``variant``, ``quantity``, ``time`` in s (NaN for frequencies), ``mode``,
        ``published``, ``computed``, ``time_error``, ``basis_error``, ``mesh_error`` (computed
        less converged; NaN where not known), ``converged`` and ``uncertainty``.
        """
        import pandas as pd

        return pd.concat(map(_frame, self.variants.values()), ignore_index=True)


def _frame(variant: VariantConvergence) -> pd.DataFrame:
    import pandas as pd

    errors = {f"{ladder.part}_error": ladder.error for ladder in variant.ladders}
    return pd.DataFrame(
        {
            "variant": variant.name,
            "quantity": [" ".join(map(str, check.target)) for check in variant.checks],
            "time": [check.time for check in variant.checks],
            "mode": [check.mode for check in variant.checks],
            "published": variant.published,
            "computed": variant.computed,
            **errors,
            "converged": variant.converged,
            "uncertainty": variant.uncertainty,
        }
    )


def _summed(parts: list[FloatArray], values: int) -> FloatArray:
    """Return the sum of the parts that are known of anything, (values,)."""
    total = np.zeros(values)
    for part in parts:
        if not np.isnan(part).all():
            total = total + part
    return total
