"""What shafts that turn do to a problem: gyroscopic matrices, and masses out of centre."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.errors import InputError

if TYPE_CHECKING:
    from bumpstop import _core
    from bumpstop.arguments import FloatArray
    from bumpstop.loads.shaft_rotation import ShaftRotation
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Problem
    from bumpstop.structure.model import LinearModel

__all__ = [
    "accelerated",
    "acceleration_field",
    "changing_shaft",
    "check_rotation",
    "turned_basis",
    "with_rotations",
]

_PLANES = {
    "x": (("dz", "dry"), ("dy", "drz")),
    "y": (("dx", "drz"), ("dz", "drx")),
    "z": (("dy", "drx"), ("dx", "dry")),
}
"""Of a shaft along each axis: dofs of the planes about the second axis across it, and the third."""
_NOTHING = 1e-12
"""Couplings below this part of the largest are rounding."""


def changing_shaft(problem: Problem) -> str | None:
    """Return what turns at a speed that changes, in words; None where nothing does."""
    rotation = problem.rotation
    if rotation is not None and rotation.constant_speed is None:
        return "the rotation of the shaft"
    for load in problem.loads:
        # Few loads turn: asked for so that those are not imported where nobody has them.
        own = getattr(load, "rotation", None)
        if own is not None and own.constant_speed is None:
            return f"the unbalance {load.name!r}"
    return None


def check_rotation(problem: Problem) -> None:
    """Refuse a rotation that the basis or the duration of a problem does not go with.

    Raises
    ------
    InputError
        If it is such.
    """
    rotation = problem.rotation
    for load in problem.loads:
        own = getattr(load, "rotation", None)
        if own is not None:
            own.check_duration(problem.duration)
    if rotation is None:
        return
    rotation.check_duration(problem.duration)
    if problem.basis.unreduced:
        hint = "take a modal basis"
        raise InputError("is not taken by a full model", key="rotation", hint=hint)
    if rotation.constant_speed is None:
        _accelerating(problem.basis, rotation)


def turned_basis(problem: Problem) -> ModalBasis:
    """Return the basis with its gyroscopic matrix at the constant speed of the rotation.

    Where the speed changes it has none.
    """
    basis, rotation = problem.basis, problem.rotation
    if rotation is None or basis.gyroscopic is None:
        return basis
    speed = rotation.constant_speed or 0.0
    return replace(basis, gyroscopic=basis.gyroscopic * (speed / rotation.spin) if speed else None)


def with_rotations(problem: Problem, system: _core.System) -> _core.System:
    """Return the system with all that turns at a speed that changes."""
    basis, rotation = problem.basis, problem.rotation
    if rotation is not None and rotation.constant_speed is None and basis.gyroscopic is not None:
        matrices = (basis.gyroscopic / rotation.spin, _accelerating(basis, rotation))
        system = system.with_rotation(rotation.core, gyroscopic=matrices)
    for load in problem.loads:
        own = getattr(load, "rotation", None)
        whirling = getattr(load, "whirling", None)
        if own is not None and whirling is not None and own.constant_speed is None:
            system = system.with_rotation(own.core, unbalance=whirling(basis))
    return system


def _accelerating(basis: ModalBasis, rotation: ShaftRotation) -> FloatArray:
    """Return what the angular acceleration multiplies beside the stiffness, (N, N), at 1 rad/s2."""
    modes = len(basis.omega2)
    if basis.gyroscopic is None or rotation.acceleration_terms == "none":
        return np.zeros((modes, modes))
    if rotation.acceleration_terms == "fixed_axis":
        return basis.gyroscopic / rotation.spin
    if basis.model is None:
        what = 'needs a structure where acceleration_terms are "lagrange"'
        hint = 'take "fixed_axis" or "none"'
        raise InputError(what, key="rotation", hint=hint)
    return basis.shapes.T @ acceleration_field(basis, rotation)


def acceleration_field(basis: ModalBasis, rotation: ShaftRotation) -> FloatArray:
    """Return what the angular acceleration multiplies beside the stiffness, (dofs, N), at 1 rad/s2.

    The basis was made from a structure.
    """
    model, shapes = basis.model, basis.shapes
    assert model is not None
    if rotation.acceleration_terms == "none":
        return np.zeros_like(shapes)
    if rotation.acceleration_terms == "fixed_axis":
        return (model.gyroscopic @ shapes) / rotation.spin
    rows, _ = _PLANES[_shaft_axis(model)]
    coupled: FloatArray = model.gyroscopic @ accelerated(basis, rotation)
    return _of_dofs(model, rows) * coupled / rotation.spin


def accelerated(basis: ModalBasis, rotation: ShaftRotation) -> FloatArray:
    """Return what of the shapes the angular acceleration acts on, (dofs, N).

    The basis was made from a structure.
    """
    model, shapes = basis.model, basis.shapes
    assert model is not None
    if rotation.acceleration_terms != "lagrange":
        return shapes if rotation.acceleration_terms == "fixed_axis" else np.zeros_like(shapes)
    _, columns = _PLANES[_shaft_axis(model)]
    return _of_dofs(model, columns) * shapes


def _of_dofs(model: LinearModel, kinds: tuple[str, ...]) -> FloatArray:
    """Return one for each dof of some kinds and zero for the others, (dofs, 1)."""
    return np.isin([dof for _, dof in model.dofs], kinds).astype(np.float64)[:, np.newaxis]


def _shaft_axis(model: LinearModel) -> str:
    """Return the global axis along which all lies that spins.

    Gyroscopic moments couple rotations about the two axes across a shaft.
    """
    kinds = np.array([dof for _, dof in model.dofs])
    sizes = {}
    for axis, (about_second, about_third) in _PLANES.items():
        at_second = np.flatnonzero(kinds == about_second[1])
        columns = np.zeros((len(kinds), 1))
        columns[kinds == about_third[1]] = 1.0
        sizes[axis] = float(
            np.abs(model.gyroscopic.magnitudes() @ columns)[at_second].max(initial=0.0)
        )
    largest = max(sizes.values())
    found = [axis for axis, size in sizes.items() if size > _NOTHING * largest]
    if len(found) != 1:
        what = 'needs shafts along one global axis where acceleration_terms are "lagrange"'
        hint = 'take "fixed_axis" or "none"'
        raise InputError(what, key="rotation", hint=hint)
    return found[0]
