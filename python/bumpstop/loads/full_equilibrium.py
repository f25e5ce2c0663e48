"""What an equilibrium of a full model lies in: the static shapes of the forces that make it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bumpstop.modal.basis import ModalBasis
from bumpstop.modal.static_shapes import StaticShapes

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray

__all__ = ["static_basis"]


def static_basis(full: ModalBasis, forces: FloatArray) -> ModalBasis:
    """Return a basis that has every displacement at rest that some forces can lead to.

    At rest ``K u = F p``, whatever the sizes p of the forces are: u is a sum of the static shapes
    ``K^-1 F``, and of rigid motions. On these an equilibrium is as exact as on all dofs.

    Parameters
    ----------
    full
        The model, a `FullModel`.
    forces
        Forces on its independent dofs, one a column, (N, m).
    """
    model = full.model
    assert model is not None  # made from one
    loads = np.zeros((len(model.dofs), forces.shape[1]))
    loads[model.free] = forces
    rigid = model.expansion @ model.rigid_shapes()
    fields = np.hstack([rigid, StaticShapes(model).under(loads)])
    moving = np.abs(fields).max(axis=0) > 0.0
    return ModalBasis.from_vectors(model, fields[:, moving])
