"""The canonical form: a problem as the arrays that the core integrates."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bumpstop import _core
from bumpstop.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bumpstop.arguments import FloatArray
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Problem
    from bumpstop.structure.bearing import Bearing

__all__ = ["CanonicalForm", "canonical_form"]


class CanonicalForm(NamedTuple):
    """``q'' + (C + G) q' + diag(omega2) q = force + laws``, unit modal mass, N modes."""

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
        If something that the problem names cannot be found on the basis, or circulatory forces
        act.
    bumpstop._core.CoreError
        If the core refuses the numbers.
    """
    basis = problem.basis
    _refuse_circulatory(basis)
    modes = len(basis.omega2)
    laws = [_core.Stop(law.row(basis), law.gap, law.stiffness, law.damping) for law in problem.laws]
    force = sum((load.modal_force(basis) for load in problem.loads), np.zeros(modes))
    if problem.initial is None:
        displacement, velocity = np.zeros(modes), np.zeros(modes)
    else:
        displacement, velocity = problem.initial.modal_state(basis)
    system = _core.System(basis.omega2, *_velocity_terms(basis))
    return CanonicalForm(system, laws, force, displacement, velocity)


def _refuse_circulatory(basis: ModalBasis) -> None:
    if basis.circulatory is None:
        return
    what = "makes circulatory forces, which no method takes yet"
    film = next((each for each in _bearings(basis) if each.circulates), None)
    if film is None:
        raise InputError(f"a part of the structure {what}", key="matrices.circulatory")
    hint = "give it a symmetric matrix"
    key, value = f"bearings.{film.name}.stiffness", film.stiffness
    raise InputError(what, key=key, value=value, hint=hint)


def _bearings(basis: ModalBasis) -> Sequence[Bearing]:
    return () if basis.structure is None else basis.structure.bearings


def _velocity_terms(basis: ModalBasis) -> tuple[FloatArray, FloatArray | None]:
    """Return the damping of each mode, and the matrix of what couples velocities, if any."""
    if not basis.couples and basis.gyroscopic is None:
        return basis.damping, None
    matrix = np.diag(basis.damping) if basis.damping_matrix is None else basis.damping_matrix.copy()
    if basis.gyroscopic is not None:
        matrix += basis.gyroscopic
    own = np.maximum(matrix.diagonal(), 0.0)
    return own, matrix - np.diag(own)
