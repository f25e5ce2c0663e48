"""The spin of a model, told by its gyroscopic matrix."""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.modal.unit_motion import unit_motion
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.model import LinearModel

__all__ = ["angular_momentum"]


def angular_momentum(model: LinearModel) -> FloatArray:
    """Return the angular momentum H of all that spins in a model, (3,), in kg m2/s.

    Turning the whole model with a small rate w meets the moment ``w x H`` of the gyroscopic
    forces, whatever parts they come from.

    Raises
    ------
    InputError
        If positions of the model's nodes are not known.
    """
    turning = np.stack([unit_motion(model, rotation) for rotation in DOFS[3:]], axis=1)
    moments = turning.T @ (model.gyroscopic @ turning)
    return np.array([moments[1, 2], moments[2, 0], moments[0, 1]])
