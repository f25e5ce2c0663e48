"""Motions of a whole model along and about the global axes."""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray, one_of
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.model import LinearModel

__all__ = ["unit_motion"]


def unit_motion(model: LinearModel, direction: str) -> FloatArray:
    """Return the motion of the whole model by 1 m along an axis, or 1 rad about it, (dofs,).

    Raises
    ------
    InputError
        If the direction is not one of ``dx dy dz drx dry drz``.
    """
    along = np.array(DOFS) == one_of("direction", direction, DOFS)
    x, y, z, rx, ry, rz = along.astype(float).tolist()
    return model.rigid_field(translation=(x, y, z), rotation=(rx, ry, rz))
