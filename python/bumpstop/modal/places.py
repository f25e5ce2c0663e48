"""Where a static shape is asked for: a dof of a node, or a direction at it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from bumpstop.arguments import FloatArray, name, one_of, vector
from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.forms import LinearForm
from bumpstop.structure.model import InertiaModel, LinearModel

__all__ = ["ResolvedPlace", "resolved_places", "told_as"]

AXES = DOFS[:3]


@dataclass(frozen=True, eq=False)
class ResolvedPlace:
    """A place, found on a model.

    Parameters
    ----------
    label
        The place in words: ``B.dy``, or ``B.(0, 0.6, 0.8)``.
    load
        A unit force there (a unit moment for a rotation), one value a dof of the model.
    """

    label: str
    load: FloatArray


def resolved_places(model: LinearModel, places: object, key: str) -> list[ResolvedPlace]:
    """Find places on a model.

    Parameters
    ----------
    model
        The structure.
    places
        A list of places.
    key
        What the list is called, for errors.

    Raises
    ------
    InputError
        If it is not such a list, a node or dof is unknown, or a place cannot move.
    """
    if not isinstance(places, Sequence) or isinstance(places, str):
        what = 'must be a list of nodes with a dof or a direction, such as [("B", "dy")]'
        raise InputError(what, key=key, value=places)
    return [_resolved(model, place, f"{key}[{i}]") for i, place in enumerate(places)]


def _resolved(model: LinearModel, place: object, key: str) -> ResolvedPlace:
    if not isinstance(place, Sequence) or isinstance(place, str) or len(place) != 2:
        what = 'must be a node and a dof, or a node and a direction, such as ("B", "dy")'
        raise InputError(what, key=key, value=place)
    node = name(key, place[0])
    with told_as(key):
        label, components = _components(place[1])
        form = LinearForm.sum(
            [(part, model.displacement_form(node, dof)) for dof, part in components.items()]
        )
    load = np.zeros(len(model.dofs))
    np.add.at(load, form.dofs, form.weights)
    where = f"{node} {label}"
    if not (model.expansion.transposed() @ load).any():
        hint = "a support or a relation holds it"
        raise InputError("nothing can move here", key=key, value=where, hint=hint)
    if isinstance(model, InertiaModel) and not model.has_inertia(form):
        hint = "what it bends follows the other dofs without delay"
        raise InputError("a force here has no mass to move", key=key, value=where, hint=hint)
    return ResolvedPlace(f"{node}.{label}", load)


def _components(wanted: object) -> tuple[str, dict[str, float]]:
    """Return the dof or direction in words, and how much of each dof it is."""
    if isinstance(wanted, str):
        dof = one_of("dof", wanted, DOFS)
        return dof, {dof: 1.0}
    direction = np.array(vector("direction", wanted))
    if not direction.any():
        raise InputError("a direction must have a length", value=wanted)
    direction /= np.linalg.norm(direction)
    components = {dof: float(part) for dof, part in zip(AXES, direction, strict=True) if part}
    if len(components) == 1:
        return next(iter(components)), components
    return f"({', '.join(f'{part:.6g}' for part in direction)})", components


@contextmanager
def told_as(key: str) -> Iterator[None]:
    """Say under which key a mistake is that something below has found."""
    try:
        yield
    except InputError as error:
        raise InputError(error.what, key=key, value=error.value, hint=error.hint) from error
