"""The canonical form: a problem as the arrays that the core integrates."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bumpstop import _core
from bumpstop.errors import InputError

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Problem

__all__ = ["CanonicalForm", "canonical_form"]


class CanonicalForm(NamedTuple):
    """``q'' + C q' + diag(omega2) q = force + laws``, unit modal mass, N modes."""

    system: _core.System
    laws: list[_core.Stop]
    force: FloatArray
    """Constant modal force (N,)."""
    displacement: FloatArray
    """Modal displacement at t = 0 (N,)."""
    velocity: FloatArray
    """Modal velocity at t = 0 (N,)."""


def canonical_form(problem: Problem) -> CanonicalForm:
    """Return a problem as the core sees it: no nodes, no names, no units.

    Raises
    ------
    InputError
        If something that the problem names cannot be found on the basis, or more than the
        laws couples its modes.
    bumpstop._core.CoreError
        If the core refuses the numbers.
    """
    basis = problem.basis
    _refuse_coupling(basis)
    modes = len(basis.omega2)
    laws = [_core.Stop(law.row(basis), law.gap, law.stiffness, law.damping) for law in problem.laws]
    force = sum((load.modal_force(basis) for load in problem.loads), np.zeros(modes))
    if problem.initial is None:
        displacement, velocity = np.zeros(modes), np.zeros(modes)
    else:
        displacement, velocity = problem.initial.modal_state(basis)
    system = _core.System(basis.omega2, basis.damping)
    return CanonicalForm(system, laws, force, displacement, velocity)


def _refuse_coupling(basis: ModalBasis) -> None:
    """Raise where more than the laws couples the modes: the core cannot integrate that yet."""
    for what in ("gyroscopic", "circulatory"):
        if getattr(basis, what) is not None:
            hint = "leave out what spins, and bearings of unequal cross stiffness"
            raise InputError(f"{what} forces couple the modes", key="basis", hint=hint)
    if basis.couples:
        hint = 'make the basis with damping_coupling="diagonal", which keeps their own damping'
        raise InputError("damping couples the modes", key="basis", hint=hint)
