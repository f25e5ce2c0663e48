"""How many inner shapes a component keeps."""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.modal.eigen import model_modes
from bumpstop.modal.selection import LowestModes
from bumpstop.structure.model import VibratingModel

__all__ = ["flexible_modes"]


def flexible_modes(model: VibratingModel, modes: object, rigid: int) -> FloatArray:
    """Return the shapes of the lowest modes of a model that strain it, (dofs, count).

    Parameters
    ----------
    model
        The model.
    modes
        How many, 0 or more, or ``"all"``.
    rigid
        Number of its rigid modes.

    Raises
    ------
    InputError
        If it is neither, or there are fewer modes.
    """
    most = len(model.free) - rigid
    count = _count(modes, most)
    if count == 0:
        return np.zeros((model.expansion.shape[0], 0))
    modes_with_rigid = model_modes(model, LowestModes(rigid + count))
    # Not the first ones: a model that buckles has modes below its rigid ones.
    return modes_with_rigid.shapes[:, modes_with_rigid.omega2 != 0.0]


def _count(modes: object, most: int) -> int:
    if isinstance(modes, str) and modes == "all":
        return most
    if isinstance(modes, bool | str) or not isinstance(modes, int | np.integer) or modes < 0:
        raise InputError('must be a whole number, 0 or more, or "all"', key="modes", value=modes)
    if modes > most:
        hint = f"the component has {most} of them"
        raise InputError("more modes than there are", key="modes", value=modes, hint=hint)
    return int(modes)
