"""Vectors and shapes that a user hands over, checked."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from bumpstop.arguments import FloatArray, name, one_of, positive, series
from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.model import LinearModel

__all__ = ["given_components", "given_labels", "given_vectors", "modal_masses", "one_or_each"]

ROUNDING = 1e-9
"""Motion of a held dof below this, relative to the largest of its vector, is rounding."""


def given_vectors(model: LinearModel, vectors: object) -> FloatArray:
    """Return displacement fields of a model, one a column, (dofs, U).

    Raises
    ------
    InputError
        If they are not numbers, not finite or of another size, or move what the model holds.
    """
    fields = _table(vectors, len(model.dofs))
    for number, field in enumerate(fields.T, start=1):
        moved = model.expansion @ field[model.free]
        wrong = np.flatnonzero(np.abs(field - moved) > ROUNDING * np.abs(field).max())
        if len(wrong):
            node, dof = model.dofs[wrong[0]]
            raise InputError(
                f"vector {number} moves {dof} of {node}, which is not free to move so",
                key="vectors",
                value=float(field[wrong[0]]),
                hint="take the model's expansion @ vectors[free]",
            )
    return fields


def given_labels(labels: Sequence[str], count: int) -> tuple[str, ...]:
    """Return what each of ``count`` vectors is called.

    Raises
    ------
    InputError
        If there is another number of labels, or one is no text.
    """
    if not labels:
        return tuple(f"vector {number}" for number in range(1, count + 1))
    if len(labels) != count:
        what = f"must be one for each of the {count} vectors"
        raise InputError(what, key="labels", value=f"{len(labels)} labels")
    return tuple(name("labels", label) for label in labels)


def modal_masses(modal_mass: object, modes: int) -> FloatArray:
    """Return one modal mass a mode (modes,) in kg, from one for all or one for each.

    Raises
    ------
    InputError
        If a mass is not positive, or their number is not that of the modes.
    """
    return one_or_each("modal_mass", modal_mass, modes, positive)


def one_or_each(
    key: str, value: object, modes: int, checked: Callable[[str, object], float]
) -> FloatArray:
    """Return one number a mode (modes,), from one for all or one for each.

    Raises
    ------
    InputError
        If a number is refused by the check, or there are not as many as modes.
    """
    if np.ndim(value) == 0:  # type: ignore[arg-type]  # object: the check is what is done here
        return np.full(modes, checked(key, value))
    numbers = series(key, value)
    if len(numbers) != modes:
        what = f"must be one number, or one for each of the {modes} modes"
        raise InputError(what, key=key, value=value)
    return np.array([checked(key, number) for number in numbers])


def given_components(shapes: object, modes: int) -> FloatArray:
    """Return the components of modes, one row a node and dof, (rows, modes).

    Raises
    ------
    InputError
        If the shapes are no mapping of nodes and dofs to one number a mode.
    """
    if not isinstance(shapes, Mapping) or not shapes:
        what = 'must map (node, dof) to components, such as {("P", "dx"): [1.0, 0.4]}'
        raise InputError(what, key="shapes", value=shapes)
    return np.array([_components(key, values, modes) for key, values in shapes.items()])


def _components(key: object, values: object, modes: int) -> tuple[float, ...]:
    """Return the components of one dof, one a mode."""
    if not isinstance(key, tuple) or len(key) != 2 or not isinstance(key[0], str):
        raise InputError("must be a node and a dof", key="shapes", value=key)
    one_of("dof", key[1], DOFS)
    components = series(f"shapes.{key[0]}.{key[1]}", values)
    if len(components) != modes:
        what = f"must have one component for each of the {modes} modes"
        raise InputError(what, key=f"shapes.{key[0]}.{key[1]}", value=values)
    return components


def _table(vectors: object, rows: int) -> FloatArray:
    try:
        fields = np.array(vectors, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError("must be numbers", key="vectors", value=vectors) from error
    if fields.ndim != 2 or len(fields) != rows or fields.shape[1] == 0:
        shape = " x ".join(map(str, fields.shape))
        what = f"must have one row for each of the {rows} dofs of the model, and a column a vector"
        raise InputError(what, key="vectors", value=shape)
    if not np.isfinite(fields).all():
        raise InputError("must be finite", key="vectors")
    return fields
