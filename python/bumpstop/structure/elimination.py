"""Dofs that relations make dependent, written by those that stay independent.

Relations are taken one after the other. What is known already is put into each; of what is
left one dof is solved for, and put into all that was known before. The dof is the one that a
relation asks for if its weight is not small among the others, else the one of largest weight,
so that rounding does not grow. A relation of which nothing is left said nothing new.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray
from bumpstop.structure.forms import LinearForm
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["Freedom", "freedom"]

_Sum: TypeAlias = dict[int, float]
"""Weights of dofs."""

_ROUNDING = 1e-10
"""A weight that is this small beside the largest one added to it has cancelled."""

_SMALL = 1e-3
"""A dof is solved for where a relation asks for it, unless its weight is smaller than this."""


@dataclass(frozen=True, eq=False)
class Freedom:
    """What can move: u = ``expansion`` @ x on all dofs, with x = u[``free``].

    Parameters
    ----------
    free
        Numbers of the independent dofs, ascending.
    expansion
        All dofs by the independent ones, (dofs, free dofs).
    """

    free: IndexArray
    expansion: SparseMatrix

    def reduced(self, matrix: SparseMatrix) -> SparseMatrix:
        """Return a matrix of all dofs as one of the free dofs, expansion' @ matrix @ expansion."""
        if len(self.expansion.values) == len(self.free):  # every dof for itself
            return matrix.restricted(self.free)
        return matrix.congruent(self.expansion)


def freedom(held: NDArray[np.bool_], zeros: Sequence[LinearForm], scale: FloatArray) -> Freedom:
    """Return what supports and relations let move.

    Parameters
    ----------
    held
        Which dofs are held at zero, (dofs,).
    zeros
        Sums of dofs that stay zero; the first dof of each is solved for, if it can be.
    scale
        Size of a typical motion of each dof, (dofs,), by which weights are compared.
    """
    elimination = _Elimination(held, scale)
    for zero in zeros:
        elimination.take(zero)
    dependent = elimination.sums
    independent = ~held
    independent[list(dependent)] = False
    free = np.flatnonzero(independent)
    rows = [dof for dof, total in dependent.items() for _ in total]
    others = [other for total in dependent.values() for other in total]
    weights = [weight for total in dependent.values() for weight in total.values()]
    place = np.cumsum(independent) - 1
    expansion = SparseMatrix.from_triplets(
        (len(held), len(free)),
        np.concatenate([free, np.array(rows, dtype=np.intp)]),
        place[np.concatenate([free, np.array(others, dtype=np.intp)])],
        np.concatenate([np.ones(len(free)), np.array(weights)]),
    )
    return Freedom(free, expansion)


class _Elimination:
    """Dependent dofs as sums of independent ones, as relations come in."""

    def __init__(self, held: NDArray[np.bool_], scale: FloatArray) -> None:
        self.sums: dict[int, _Sum] = {}
        self._held = held
        self._scale = scale
        self._users: dict[int, set[int]] = defaultdict(set)
        """The dependent dofs in whose sums an independent one stands."""

    def take(self, zero: LinearForm) -> None:
        """Let a sum of dofs be zero from now on."""
        dofs = [int(dof) for dof in zero.dofs]
        left = self._by_independent(zip(dofs, zero.weights.tolist(), strict=True))
        if not left:
            return
        dof = self._solvable(left, dofs[0])
        weight = left.pop(dof)
        solution = {other: -w / weight for other, w in left.items()}
        self._know(dof, solution)
        for user in self._users.pop(dof, ()):
            self._know(user, self._by_independent(self.sums[user].items()))

    def _by_independent(self, terms: Iterable[tuple[int, float]]) -> _Sum:
        """Return a sum by independent dofs alone, without what is rounding."""
        total: _Sum = {}
        largest: _Sum = {}
        for dof, weight in terms:
            if self._held[dof]:
                continue
            for other, w in self.sums.get(dof, {dof: 1.0}).items():
                total[other] = total.get(other, 0.0) + weight * w
                largest[other] = max(largest.get(other, 0.0), abs(weight * w))
        return {dof: w for dof, w in total.items() if abs(w) > _ROUNDING * largest[dof]}

    def _solvable(self, total: _Sum, wanted: int) -> int:
        sizes = {dof: abs(weight) * self._scale[dof] for dof, weight in total.items()}
        largest = max(sizes, key=lambda dof: sizes[dof])
        return wanted if sizes.get(wanted, 0.0) > _SMALL * sizes[largest] else largest

    def _know(self, dof: int, total: _Sum) -> None:
        self.sums[dof] = total
        for other in total:
            self._users[other].add(dof)
