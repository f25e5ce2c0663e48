"""The force of an acceleration on everything that has mass."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.arguments import FloatArray, Vector
from bumpstop.errors import InputError

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis

__all__ = ["mass_times"]


def mass_times(acceleration: Vector, basis: ModalBasis) -> FloatArray:
    """Return the masses times a uniform acceleration in m/s2, on each mode (N,).

    Raises
    ------
    InputError
        If the basis was not made from a structure, so that it has no mass matrix.
    """
    if basis.model is None or basis.mass_rows is None:
        hint = "give a NodalForce, or make the basis from a structure"
        raise InputError("needs the masses of a structure", key="acceleration", hint=hint)
    return basis.mass_rows @ basis.model.rigid_field(translation=acceleration)
