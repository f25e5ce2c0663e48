"""Vectors at a node, seen by the modes."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, Vector
from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS, Dof
from bumpstop.structure.forms import LinearForm
from bumpstop.structure.model import InertiaModel

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis

__all__ = ["ROTATIONS", "TRANSLATIONS", "along", "direction_row", "require_inertia"]

TRANSLATIONS = DOFS[:3]
ROTATIONS = DOFS[3:]


def direction_row(
    basis: ModalBasis, node: str, direction: Vector, dofs: tuple[str, ...] = TRANSLATIONS
) -> FloatArray:
    """Return ``direction . shapes`` of a node, one value a mode, shape (N,).

    It is both the motion along ``direction`` per unit of modal displacement and the modal
    force of ``direction`` taken as a force in N. Components that are zero ask nothing of the
    basis, so that a basis with shapes along x alone does for a stop along x.

    Raises
    ------
    InputError
        If the basis has no shape there, or the structure has no mass for a force to move.
    """
    row = np.zeros(len(basis.omega2))
    model = basis.model if isinstance(basis.model, InertiaModel) else None
    forms = []
    for component, dof in zip(direction, dofs, strict=True):
        if component != 0.0:
            row += component * basis.row(node, dof)
            if model is not None:
                forms.append((component, model.displacement_form(node, dof)))
    if model is not None and not model.has_inertia(LinearForm.sum(forms)):
        hint = "give the node mass" if dofs == TRANSLATIONS else "give the node rotary inertia"
        raise InputError("a force here has no mass to move", key="node", value=node, hint=hint)
    return row


def require_inertia(basis: ModalBasis, terms: Mapping[Dof, float]) -> None:
    """Raise where a force along a weighted sum of dofs accelerates no mass alone.

    Raises
    ------
    InputError
        If it does not: it would move something at once, which no mode can follow.
    """
    model = basis.model
    if isinstance(model, InertiaModel):
        forms = [(weight, model.displacement_form(*dof)) for dof, weight in terms.items()]
        if not model.has_inertia(LinearForm.sum(forms)):
            hint = "give the nodes mass, or rotary inertia where they turn"
            raise InputError("a force here has no mass to move", key="terms", hint=hint)


def along(row: FloatArray, motion: FloatArray) -> FloatArray:
    """Return a row (N,) times modal motion (time, N): the motion of what the row stands for."""
    # Not BLAS: its order of summation depends on the number of instants, so that the same
    # one could give different bits on another grid.
    values: FloatArray = np.einsum("tn,n->t", motion, row)
    return values
