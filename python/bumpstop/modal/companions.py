"""Companions of modes: static shapes that make up for the modes left out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np

from bumpstop.arguments import FloatArray, listed, one_of
from bumpstop.modal.coordinates import UserCoordinates
from bumpstop.modal.independent import NEGLIGIBLE, mass_norms, without
from bumpstop.modal.places import resolved_places, told_as
from bumpstop.modal.static_shapes import StaticShapes
from bumpstop.modal.vectors import canonical_vectors
from bumpstop.structure.dofs import DOFS, Place
from bumpstop.structure.model import LinearModel

__all__ = ["Companions", "SpatialLoad", "companions"]


class SpatialLoad(Protocol):
    """A load whose forces on a model are known."""

    @property
    def name(self) -> str:
        """What it is called."""

    def nodal_forces(self, model: LinearModel) -> FloatArray:
        """Return the forces on each dof, one a column, (dofs, n)."""


class Companions(NamedTuple):
    """Static shapes in canonical form, orthogonal to the modes beside them."""

    omega2: FloatArray
    """Their stiffness in rad2/s2 for unit modal mass, (n,)."""
    shapes: FloatArray
    """One a column, (dofs, n)."""
    labels: tuple[str, ...]
    """What the user's shapes are, those left out not among them, (n,)."""
    coordinates: UserCoordinates | None
    """How the user's shapes, each of unit modal mass, make the canonical ones."""
    dropped: tuple[str, ...]
    """Which shapes add nothing, a sentence each."""


def companions(
    model: LinearModel,
    modes: FloatArray,
    *,
    static_shapes: Sequence[Place] = (),
    constraint_shapes: Sequence[Place] = (),
    base_shapes: Sequence[str] = (),
    load_shapes: Sequence[SpatialLoad] = (),
) -> Companions:
    """Return what static shapes have beyond modes, as shapes of a basis.

    What is beyond the modes is orthogonal to them in mass and stiffness, so that the modes
    stay as they are; the shapes are made canonical among themselves.

    Parameters
    ----------
    model
        The structure.
    modes
        Its modes of unit modal mass, (dofs, m).
    static_shapes
        Places of unit forces: attachment modes.
    constraint_shapes
        Places that move by one while the others are held: constraint modes.
    base_shapes
        Directions in which the base accelerates: pseudo-modes.
    load_shapes
        Loads whose static displacements are meant.

    Raises
    ------
    InputError
        If a place or a direction is unknown, or a place cannot move.
    """
    static = StaticShapes(model)
    found = [
        *_attachment(static, model, static_shapes, modes),
        *_constraint(static, model, constraint_shapes, modes),
        *_base(static, model, base_shapes, modes),
        *_loads(static, model, load_shapes, modes),
    ]
    fresh = [shape for shape in found if shape.norm > NEGLIGIBLE * shape.whole]
    labels = [shape.label for shape in fresh]
    dropped = [
        f"{shape.label} is left out: {'the modes have all of it' if shape.whole else 'it is zero'}"
        for shape in found
        if not shape.norm > NEGLIGIBLE * shape.whole
    ]
    if not fresh:
        nothing = np.zeros((len(modes), 0))
        return Companions(np.zeros(0), nothing, (), None, tuple(dropped))
    vectors = np.stack([shape.rest / shape.norm for shape in fresh], axis=1)
    rigid = model.expansion @ model.rigid_shapes()
    canonical = canonical_vectors(vectors, model.stiffness, model.mass, rigid)
    kept = [i for i in range(len(fresh)) if i not in canonical.dropped]
    dropped += [f"{labels[number]} {why}" for number, why in canonical.dropped.items()]
    return Companions(
        canonical.omega2,
        canonical.shapes,
        tuple(labels[i] for i in kept),
        None if canonical.coordinates is None else canonical.coordinates.of(kept),
        tuple(dropped),
    )


class _Shape(NamedTuple):
    """A static shape, and what of it is beyond the modes."""

    label: str
    rest: FloatArray
    norm: float
    whole: float
    """Lengths of the rest and of the whole shape in the mass matrix."""


def _attachment(
    static: StaticShapes, model: LinearModel, places: Sequence[Place], modes: FloatArray
) -> list[_Shape]:
    found = resolved_places(model, places, "static_shapes")
    if not found:
        return []
    loads = np.stack([place.load for place in found], axis=1)
    labels = [f"static shape of {place.label}" for place in found]
    return _shapes(model, labels, static.under(loads), static.under(loads, modes))


def _constraint(
    static: StaticShapes, model: LinearModel, places: Sequence[Place], modes: FloatArray
) -> list[_Shape]:
    found = resolved_places(model, places, "constraint_shapes")
    if not found:
        return []
    whole = static.held(found, "constraint_shapes")
    rest = without(modes, without(modes, whole, model.mass), model.mass)
    return _shapes(model, [f"constraint shape of {place.label}" for place in found], whole, rest)


def _base(
    static: StaticShapes, model: LinearModel, directions: Sequence[str], modes: FloatArray
) -> list[_Shape]:
    if not directions:
        return []
    names = listed("base_shapes", directions)
    with told_as("base_shapes"):
        for name in names:
            one_of("direction", name, DOFS)
    labels = [f"base acceleration along {name}" for name in names]
    return _shapes(model, labels, static.base(names), static.base(names, modes))


def _loads(
    static: StaticShapes, model: LinearModel, loads: Sequence[SpatialLoad], modes: FloatArray
) -> list[_Shape]:
    found = []
    for load in listed("load_shapes", loads):
        forces = load.nodal_forces(model)
        labels = [f"static shape of load {load.name}"] * forces.shape[1]
        found += _shapes(model, labels, static.under(forces), static.under(forces, modes))
    return found


def _shapes(
    model: LinearModel, labels: Sequence[str], whole: FloatArray, rest: FloatArray
) -> list[_Shape]:
    sizes = (mass_norms(fields, model.mass).tolist() for fields in (rest, whole))
    return [_Shape(*shape) for shape in zip(labels, rest.T, *sizes, strict=True)]
