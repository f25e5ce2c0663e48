"""What a force that travels along a beam does to all dofs, and inside the element it is on."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.loads.along_beam import beam_nodes
from bumpstop.loads.moving_force import MovingForce
from bumpstop.post.force_field import ForceField, sums
from bumpstop.projection import TRANSLATIONS
from bumpstop.structure.smooth_pieces import SmoothPieces

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.cut import Cut
    from bumpstop.structure.model import LinearModel

__all__ = ["moving_fields"]


def moving_fields(
    load: MovingForce, basis: ModalBasis, mass_shapes: FloatArray, duration: float
) -> Iterator[ForceField]:
    """Yield the force where it is, and what the modes felt beside it.

    A run follows the shapes of the modes along straight lines. What these miss is spread over the
    structure as the modes' masses are, ``mass_shapes``, so that all nodes stay in equilibrium
    with the motion of the run.
    """
    model = basis.model
    assert model is not None  # a moving force has asked for its beam
    dofs, nodal = _nodal(load, model)
    fields = np.zeros((len(model.dofs), len(dofs)))
    fields[dofs, np.arange(len(dofs))] = 1.0

    def sizes(times: FloatArray) -> FloatArray:
        places, factors = load.passage(model, times)
        return factors[:, np.newaxis] * nodal.at(places)

    def inside(cut: Cut, times: FloatArray) -> FloatArray:
        places, factors = load.passage(model, times)
        return factors * cut.of_places(load.beam, places, np.array([*load.force, 0.0, 0.0, 0.0]))

    felt = sums([functions for _, functions in load.components(basis)], duration)
    shapes = basis.shapes[dofs]
    yield ForceField("load", fields, sizes, inside)
    yield ForceField("load", mass_shapes, lambda times: felt(times) - sizes(times) @ shapes)


def _nodal(load: MovingForce, model: LinearModel) -> tuple[list[int], SmoothPieces]:
    """Return the dofs that feel the force, and the forces on them, (dofs,), by its place."""
    nodes = beam_nodes(model, load.beam)
    corners = np.array([model.position(node) for node in nodes])
    along = np.linalg.norm(corners - corners[0], axis=1)

    def forms(place: float) -> Iterator[tuple[float, list[tuple[int, float]]]]:
        for size, dof in zip(load.force, TRANSLATIONS, strict=True):
            form = model.displacement_form(f"{load.beam}@{place!r}", dof)
            yield size, list(zip(form.dofs.tolist(), form.weights.tolist(), strict=True))

    middles = (0.5 * (along[1:] + along[:-1])).tolist()
    dofs = sorted({dof for place in middles for _, form in forms(place) for dof, _ in form})
    row = {dof: number for number, dof in enumerate(dofs)}

    def forces(place: float) -> FloatArray:
        found = np.zeros(len(dofs))
        for size, form in forms(place):
            for dof, weight in form:
                found[row[dof]] += size * weight
        return found

    return dofs, SmoothPieces(forces, along)
