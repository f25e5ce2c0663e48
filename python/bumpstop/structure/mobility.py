"""What can move: not held, not told by other dofs, not without inertia."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.structure.dofs import Dof
from bumpstop.structure.elimination import Freedom
from bumpstop.structure.forms import LinearForm
from bumpstop.structure.massless import condensed, idle_motions, massless_motions, without
from bumpstop.structure.sparse import SparseMatrix

__all__ = ["Mobility", "mobility"]


@dataclass(frozen=True, eq=False)
class Mobility:
    """What can move, by stages.

    Parameters
    ----------
    allowed
        What supports and relations allow, without the motions that have neither inertia nor
        resistance.
    freedom
        Of that, what has inertia; the rest follows it in equilibrium.
    massless
        Motions of all dofs without inertia, (dofs, motions): those left out and those that
        follow. A force on them would find nothing to accelerate.
    """

    allowed: Freedom
    freedom: Freedom
    massless: SparseMatrix

    def has_inertia(self, form: LinearForm) -> bool:
        """Tell whether a force along a form accelerates masses alone."""
        weights = np.zeros(self.massless.shape[0])
        np.add.at(weights, form.dofs, form.weights)
        work = np.zeros(self.massless.shape[1])
        np.add.at(work, self.massless.columns, weights[self.massless.rows] * self.massless.values)
        sizes = np.abs(form.weights).max(initial=0.0)
        return bool(np.all(np.abs(work) <= 1e-9 * sizes))


def mobility(
    dofs: tuple[Dof, ...],
    told: Freedom,
    scale: FloatArray,
    massive: NDArray[np.bool_],
    matrices: Mapping[str, SparseMatrix],
) -> Mobility:
    """Return what can move of what supports and relations allow.

    Parameters
    ----------
    dofs
        Node and dof of each row.
    told
        What supports and relations allow.
    scale
        Size of a typical motion of each dof, (dofs,).
    massive
        Which dofs have inertia in any motion, as far as that is known, (dofs,).
    matrices
        The five matrices of a model by name, on all dofs.

    Raises
    ------
    InputError
        If a motion without inertia is damped or pushed away by a negative stiffness, or nothing
        with inertia can move.
    """
    motions = massless_motions(told, matrices["mass"], massive)
    massless = told.expansion.times(motions)
    if motions.shape[1] == 0:
        return Mobility(told, told, massless)
    for kind, part in _DELAYING.items():
        _refuse(told, motions, matrices[kind], dofs, part)
    stiffness = told.reduced(matrices["stiffness"])
    idle = idle_motions(motions, stiffness)
    _refuse_unstable(told, motions, idle, stiffness, dofs)
    allowed = without(told, idle, scale[told.free]) if idle.shape[1] else told
    motions = massless_motions(allowed, matrices["mass"], massive)
    freedom = allowed
    if motions.shape[1]:
        freedom = condensed(allowed, motions, allowed.reduced(matrices["stiffness"]))
    if len(freedom.free) == 0:
        raise InputError("nothing that can move has mass", hint="add masses, or give beams density")
    return Mobility(allowed, freedom, massless)


_CANCELLED = 1e-12
"""A force this small beside the sizes of its terms is rounding."""

_DELAYING = {
    "damping": "a damper",
    "gyroscopic": "a gyroscopic moment",
    "circulatory": "a bearing with cross stiffness",
}
"""Parts under which a motion without inertia would not follow at once."""


def _refuse(
    freedom: Freedom, motions: SparseMatrix, matrix: SparseMatrix, dofs: tuple[Dof, ...], part: str
) -> None:
    own = freedom.reduced(matrix)
    forces = own.times(motions)
    sizes = own.magnitudes().times(motions.magnitudes()).values
    acting = np.abs(forces.values) > _CANCELLED * sizes
    if acting.any():
        moved, weights = motions.dense_columns(forces.columns[acting][:1])
        node, dof = dofs[freedom.free[moved[np.abs(weights[:, 0]).argmax()]]]
        raise _has_no_mass(node, f"{dof} is moved by {part}")


def _refuse_unstable(
    freedom: Freedom,
    motions: SparseMatrix,
    idle: SparseMatrix,
    stiffness: SparseMatrix,
    dofs: tuple[Dof, ...],
) -> None:
    from bumpstop.structure.unstable import unstable_motion

    motion = unstable_motion(motions, idle, stiffness)
    if motion is not None:
        node, dof = dofs[freedom.free[np.abs(motion).argmax()]]
        raise _has_no_mass(node, f"{dof} is pushed away by a negative stiffness")


def _has_no_mass(node: str, what: str) -> InputError:
    hint = "give the node mass, or rotary inertia"
    return InputError(f"{what}, but has no mass", key=f"nodes.{node}", hint=hint)
