"""Running a full model: its arrays, the dofs that are kept, and its step."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING

import numpy as np

from bumpstop import _core
from bumpstop.canonical import forcing, obstacle_motions
from bumpstop.modal.full import FullModel

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.problem import Problem
    from bumpstop.structure.gauge import Gauge
    from bumpstop.structure.sparse import IndexArray

__all__ = ["KEPT", "full_problem", "kept_dofs"]

KEPT = 2**30
"""Bytes up to which the motion of all dofs is kept."""
NUMBERS = 8
"""Numbers that the core keeps of a dof and step: cubics of displacement and velocity."""


def kept_dofs(problem: Problem, steps: float) -> IndexArray:
    """Return the coordinates whose motion a run keeps: all, or those that something names."""
    basis = problem.basis
    count = len(basis.omega2)
    if 8.0 * NUMBERS * count * steps <= KEPT:
        return np.arange(count)
    asked = _Asked(**{part.name: getattr(basis, part.name) for part in fields(basis)})
    for law in problem.laws:
        law.core(asked)
    for node, dof in problem.outputs:
        asked.row(node, dof)
    for gauge in problem.gauges:
        asked.gauge_row(gauge)
    return np.array(sorted(asked.named), dtype=np.intp)


def full_problem(problem: Problem, kept: IndexArray) -> _core.FullProblem:
    """Return a problem of a full model as the core sees it.

    Raises
    ------
    InputError
        If something that the problem names cannot be found.
    bumpstop._core.CoreError
        If the core refuses the numbers.
    """
    basis = problem.basis
    assert isinstance(basis, FullModel)  # by its caller
    start = np.zeros((2, len(basis.omega2)))
    if problem.initial is not None:
        start[0], start[1] = problem.initial.modal_state(basis)
    seen = basis.only(kept)
    return _core.FullProblem(
        [matrix.arrays for matrix in basis.matrices],
        forcing(problem),
        start,
        kept,
        [law.core(seen) for law in problem.laws],
        obstacle_motions(problem, _core.Forcing(np.zeros(len(kept)))),
        problem.duration,
    )


@dataclass(frozen=True, eq=False)
class _Asked(FullModel):
    """A full model that takes note of the coordinates that it is asked for."""

    named: set[int] = field(default_factory=set)

    def row(self, node: str, dof: str) -> FloatArray:
        return self._noted(super().row(node, dof))

    def gauge_row(self, gauge: Gauge) -> FloatArray:
        return self._noted(super().gauge_row(gauge))

    def _noted(self, row: FloatArray) -> FloatArray:
        self.named.update(np.flatnonzero(row).tolist())
        return row
