"""Beams of a model, as loads along them ask for them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from bumpstop.errors import InputError, blamed
from bumpstop.structure.model import BeamModel

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.model import LinearModel

__all__ = ["beam_length", "beam_nodes", "model_of"]


def model_of(basis: ModalBasis, beam: str) -> LinearModel:
    """Return the model that a basis was made from.

    Raises
    ------
    InputError
        If there is none, so that it has no beams.
    """
    if basis.model is None:
        hint = "make the basis from a structure"
        raise InputError("the basis has no beams", key="beam", value=beam, hint=hint)
    return basis.model


def beam_nodes(model: LinearModel, beam: str) -> tuple[str, ...]:
    """Return the nodes of a beam, from end to end.

    Raises
    ------
    InputError
        If the model has no beams, or none of this name.
    """
    if not isinstance(model, BeamModel):
        raise InputError("the structure has no beams", key="beam", value=beam)
    with blamed("beam"):
        return model.beam_nodes(beam)


def beam_length(model: LinearModel, beam: str) -> float:
    """Return the length of a beam in m.

    Raises
    ------
    InputError
        If the model has no such beam.
    """
    nodes = beam_nodes(model, beam)
    return math.dist(model.position(nodes[0]), model.position(nodes[-1]))
