"""The canonical form: a problem as the arrays that the core integrates."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bumpstop import _core

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Problem

__all__ = ["CanonicalForm", "canonical_form"]


class CanonicalForm(NamedTuple):
    """``q'' + (C + G) q' + (diag(omega2) + N) q = force + laws``, unit modal mass.

    N is the circulatory matrix.
    """

    system: _core.System
    laws: list[_core.Law]
    force: FloatArray
    """Constant modal force, one entry a mode."""
    displacement: FloatArray
    """Modal displacement at t = 0."""
    velocity: FloatArray
    """Modal velocity at t = 0."""


def canonical_form(problem: Problem) -> CanonicalForm:
    """Return a problem as the core sees it: no nodes, no names, no units.

    Raises
    ------
    InputError
        If something that the problem names cannot be found on the basis.
    bumpstop._core.CoreError
        If the core refuses the numbers.
    """
    basis = problem.basis
    modes = len(basis.omega2)
    laws = [law.core(basis) for law in problem.laws]
    force = sum((load.modal_force(basis) for load in problem.loads), np.zeros(modes))
    if problem.initial is None:
        displacement, velocity = np.zeros(modes), np.zeros(modes)
    else:
        displacement, velocity = problem.initial.modal_state(basis)
    system = _core.System(basis.omega2, *_velocity_terms(basis), basis.circulatory)
    return CanonicalForm(system, laws, force, displacement, velocity)


def _velocity_terms(basis: ModalBasis) -> tuple[FloatArray, FloatArray | None]:
    """Return the damping of each mode, and the matrix of what couples velocities, if any."""
    if not basis.couples and basis.gyroscopic is None:
        return basis.damping, None
    matrix = np.diag(basis.damping) if basis.damping_matrix is None else basis.damping_matrix.copy()
    if basis.gyroscopic is not None:
        matrix += basis.gyroscopic
    own = np.maximum(matrix.diagonal(), 0.0)
    return own, matrix - np.diag(own)
