"""What supports that move do to laws and results: all is carried along."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.laws.coordinate import coordinates_of
from bumpstop.loads.moving_supports import MovingSupports
from bumpstop.loads.support_motion import SupportMotion
from bumpstop.loads.time import resolved, scaled
from bumpstop.structure.model import StrainModel

if TYPE_CHECKING:
    from bumpstop.laws.coordinate import Coordinate
    from bumpstop.loads.time import TimeFunction
    from bumpstop.problem import Law, Problem
    from bumpstop.structure.forms import LinearForm
    from bumpstop.structure.gauge import Gauge

__all__ = [
    "base_acceleration",
    "carried_field",
    "carried_form",
    "carried_gauge",
    "carried_node",
    "carried_obstacles",
    "carried_past",
    "check_supports",
]

_NOTHING = 1e-12
"""A coordinate that moves less than this, relative to what carries it, stays."""


def carried_node(
    problem: Problem, node: str, dof: str, times: FloatArray, derivative: int
) -> FloatArray:
    """Return what supports that move add to the motion of a node, (time,).

    Zero where results are told from the supports.

    Parameters
    ----------
    problem
        The problem.
    node, dof
        What moves.
    times
        In s.
    derivative
        0 for displacement, 1 for velocity, 2 for acceleration.
    """
    model = problem.basis.model
    assert model is not None  # without one no load moves supports
    return carried_form(problem, model.displacement_form(node, dof), times, derivative)


def carried_gauge(problem: Problem, gauge: Gauge, times: FloatArray) -> FloatArray:
    """Return the strain of a gauge that supports make as they move apart, (time,)."""
    model = problem.basis.model
    assert isinstance(model, StrainModel)  # the problem has checked its gauges
    return carried_form(problem, model.strain_form(gauge), times, 0)


def check_supports(problem: Problem) -> None:
    """Refuse motions of supports that cannot be followed, and frames that do not go together.

    Raises
    ------
    InputError
        If there are such.
    """
    carriers = [load for load in problem.loads if isinstance(load, MovingSupports)]
    if len({load.is_absolute for load in carriers}) > 1:
        what = "must be the same for all motions of supports"
        relative = next(load.name for load in carriers if not load.is_absolute)
        hint = 'take "absolute" where some supports move by themselves'
        raise InputError(what, key=f"loads.{relative}.frame", value="relative", hint=hint)
    for load in carriers:
        if load.is_absolute:
            _check_travel(load, problem.duration)
    carried_obstacles(problem)


def _check_travel(load: MovingSupports, duration: float) -> None:
    try:
        load.travel(duration)
    except InputError as error:
        key = f"loads.{load.name}.{error.key}"
        raise InputError(error.what, key=key, value=error.value, hint=error.hint) from error


def carried_form(
    problem: Problem, form: LinearForm, times: FloatArray, derivative: int = 0
) -> FloatArray:
    """Return what supports that move add to a linear form of the displacements, (time,)."""
    total = np.zeros(len(times))
    for load in problem.loads:
        if isinstance(load, MovingSupports) and load.is_absolute and problem.basis.model:
            size = float(form.of(load.field(problem.basis.model)))
            if size != 0.0:
                total += size * load.travel(problem.duration).at(times, derivative)
    return total


def base_acceleration(problem: Problem, node: str, dof: str, times: FloatArray) -> FloatArray:
    """Return the acceleration of a base that results are told from, at a node, (time,).

    Zero where they are told from the still ground.
    """
    total = np.zeros(len(times))
    model = problem.basis.model
    for load in problem.loads:
        if model is not None and isinstance(load, MovingSupports) and not load.is_absolute:
            size = float(model.displacement_form(node, dof).of(load.field(model)))
            functions = load.accelerations
            terms = resolved(functions, problem.duration) or functions
            total += size * (sum(term.at(times) for term in terms) if terms else 1.0)
    return total


def carried_field(problem: Problem, times: FloatArray, derivative: int = 0) -> FloatArray:
    """Return what supports that move add to the motion of all dofs, (time, dofs).

    Zero where results are told from the supports.
    """
    model = problem.basis.model
    assert model is not None  # without one no load moves supports
    total = np.zeros((len(times), len(model.dofs)))
    for load in problem.loads:
        if isinstance(load, MovingSupports) and load.is_absolute:
            total += np.outer(
                load.travel(problem.duration).at(times, derivative), load.field(model)
            )
    return total


def carried_obstacles(problem: Problem) -> list[list[tuple[TimeFunction, ...]]]:
    """Return, for each coordinate of each law, how its obstacle moves as the modes tell it.

    Raises
    ------
    InputError
        If a rigid stop would have to follow supports.
    """
    carriers: list[MovingSupports] = [
        load for load in problem.loads if isinstance(load, MovingSupports)
    ]
    return [_motions(law, carriers, problem) for law in problem.laws]


def carried_past(
    problem: Problem,
    law: Law,
    coordinates: Sequence[Coordinate],
    times: FloatArray,
    derivative: int = 0,
) -> FloatArray:
    """Return how supports carry the structure past the obstacle of a law, (time, coordinates).

    It is what they add to the motion that the modes tell, as seen from the obstacle: nothing
    where this moves with them.
    """
    total = np.zeros((len(times), len(coordinates)))
    model = problem.basis.model
    for load in problem.loads:
        if model is not None and isinstance(load, MovingSupports) and _passes(load, law):
            field = load.field(model)
            sizes = [float(each.nodal_force(model) @ field) for each in coordinates]
            total += np.outer(load.travel(problem.duration).at(times, derivative), sizes)
    return total


def _passes(load: MovingSupports, law: Law) -> bool:
    """Return whether a motion of supports carries the structure past an obstacle."""
    return isinstance(load, SupportMotion) or getattr(law, "frame", "relative") == "absolute"


def _motions(
    law: Law, carriers: Sequence[MovingSupports], problem: Problem
) -> list[tuple[TimeFunction, ...]]:
    """Return the functions whose sums move the obstacle of a law along its coordinates."""
    basis = problem.basis
    passing = [load for load in carriers if _passes(load, law)]
    if basis.model is None or not passing:
        return []
    along = [each.nodal_force(basis.model) for each in coordinates_of(law, basis)]
    motions: list[list[TimeFunction]] = [[] for _ in along]
    for load in passing:
        field = load.field(basis.model)
        negligible = _NOTHING * float(np.abs(field).max())
        for direction, functions in zip(along, motions, strict=True):
            size = float(direction @ field)
            if abs(size) <= negligible:
                continue
            if hasattr(law, "restitution"):
                what = f"cannot follow the supports that {load.name!r} moves"
                hint = "rigid stops do not; give it a stiffness"
                raise InputError(what, key=f"{law.table}.{law.name}", hint=hint)
            travel = load.travel(problem.duration).displacement
            functions.extend(scaled(function, -size) for function in travel)
    return [tuple(functions) for functions in motions]
