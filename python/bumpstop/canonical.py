"""The canonical form: a problem as the arrays that the core integrates."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bumpstop import _core

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bumpstop.arguments import FloatArray
    from bumpstop.continued import LawStates
    from bumpstop.loads.time import TimeFunction
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Problem

__all__ = ["CanonicalForm", "canonical_form", "forcing", "obstacle_motions", "velocity_matrix"]


class CanonicalForm(NamedTuple):
    """``q'' + (C + G) q' + (diag(omega2) + N) q = forces + laws``, unit modal mass.

    N is the circulatory matrix.
    """

    system: _core.System
    laws: list[_core.Law]
    forcing: _core.Forcing
    """Modal forces over time, one entry a mode."""
    displacement: FloatArray
    """Modal displacement at t = 0."""
    velocity: FloatArray
    """Modal velocity at t = 0."""
    states: LawStates | None
    """The laws' states at t = 0, where they go on in those of another run."""


def canonical_form(problem: Problem) -> CanonicalForm:
    """Return a problem as the core sees it: no nodes, no names, no units.

    Raises
    ------
    InputError
        If something that the problem names cannot be found on the basis.
    bumpstop._core.CoreError
        If the core refuses the numbers.
    """
    basis = problem.basis
    modes = len(basis.omega2)
    laws = [law.core(basis) for law in problem.laws]
    if problem.initial is None:
        displacement, velocity = np.zeros(modes), np.zeros(modes)
    else:
        displacement, velocity = problem.initial.modal_state(basis)
    for law in problem.laws:
        # Few laws have it: asked for so that those are not imported where nobody has them.
        check = getattr(law, "check_start", None)
        if check is not None:
            check(basis, displacement)
    system = _system(problem)
    loads = obstacle_motions(problem, forcing(problem))
    states = getattr(problem.initial, "law_states", None)
    return CanonicalForm(system, laws, loads, displacement, velocity, states)


def _system(problem: Problem) -> _core.System:
    """Return the structure, with all that turns."""
    basis = problem.basis
    turns = problem.rotation is not None or any(hasattr(load, "rotation") for load in problem.loads)
    if not turns:
        return _core.System(basis.omega2, *_velocity_terms(basis), basis.circulatory)
    from bumpstop.turning import turned_basis, with_rotations

    still = _velocity_terms(turned_basis(problem))
    return with_rotations(problem, _core.System(basis.omega2, *still, basis.circulatory))


def obstacle_motions(problem: Problem, loads: _core.Forcing) -> _core.Forcing:
    """Return loads with the motions of obstacles beside them."""
    # Few obstacles move: what follows them is imported where one does.
    own = [getattr(law, "motions", ()) for law in problem.laws]
    moved = [
        ((law, coordinate), functions)
        for motions in (own, _carried(problem))
        for law, along in enumerate(motions)
        for coordinate, functions in enumerate(along)
        if functions
    ]
    return _with_motions(loads, moved, problem.duration) if moved else loads


def _carried(problem: Problem) -> Sequence[Sequence[Sequence[TimeFunction]]]:
    """Return how obstacles move, law by law and coordinate by coordinate, because supports do."""
    if not problem.supports_move:
        return ()
    from bumpstop.carried import carried_obstacles

    return carried_obstacles(problem)


def forcing(problem: Problem) -> _core.Forcing:
    """Return the modal forces of all loads, without motions of obstacles."""
    constant = np.zeros(len(problem.basis.omega2))
    changing = []
    for load in problem.loads:
        for force, functions in load.components(problem.basis):
            if functions:
                changing.append((force, functions))
            else:
                constant += force
    if not changing:
        return _core.Forcing(constant)
    from bumpstop.loads.time import Harmonic, Polynomial, TimeTable, resolved

    polynomials, harmonics, tables = [], [], []
    terms = [
        (force, term)
        for force, functions in changing
        for term in resolved(functions, problem.duration)
    ]
    for force, function in terms:
        match function:
            case Polynomial():
                polynomials.append((force, np.array(function.coefficients)))
            case Harmonic():
                omega = 2.0 * np.pi * function.frequency
                harmonics.append((omega, function.cosine * force, function.sine * force))
            case TimeTable():
                times, values = np.asarray(function.times), np.asarray(function.values)
                tables.append((force, times, values, function.beyond == "hold"))
    return _core.Forcing(constant, polynomials, harmonics, tables)


def _with_motions(
    loads: _core.Forcing,
    moved: Sequence[tuple[tuple[int, int], Sequence[TimeFunction]]],
    duration: float,
) -> _core.Forcing:
    """Return loads with the motions of obstacles, by the numbers of law and coordinate."""
    from bumpstop.loads.time import Harmonic, Polynomial, TimeTable, resolved

    polynomials, harmonics, tables = [], [], []
    for obstacle, function in (
        (obstacle, term) for obstacle, functions in moved for term in resolved(functions, duration)
    ):
        match function:
            case Polynomial():
                polynomials.append((obstacle, np.array(function.coefficients)))
            case Harmonic():
                omega = 2.0 * np.pi * function.frequency
                harmonics.append((obstacle, omega, function.cosine, function.sine))
            case TimeTable():
                times, values = np.asarray(function.times), np.asarray(function.values)
                # One that says nothing covers the run: its ends are no jumps.
                tables.append((obstacle, times, values, function.beyond != "zero"))
    return loads.with_motions(polynomials, harmonics, tables)


def velocity_matrix(basis: ModalBasis) -> FloatArray:
    """Return all that multiplies modal velocities: damping and gyroscopic matrix, (N, N)."""
    matrix = np.diag(basis.damping) if basis.damping_matrix is None else basis.damping_matrix.copy()
    if basis.gyroscopic is not None:
        matrix += basis.gyroscopic
    return matrix


def _velocity_terms(basis: ModalBasis) -> tuple[FloatArray, FloatArray | None]:
    """Return the damping of each mode, and the matrix of what couples velocities, if any."""
    if not basis.couples and basis.gyroscopic is None:
        return basis.damping, None
    matrix = velocity_matrix(basis)
    own = np.maximum(matrix.diagonal(), 0.0)
    return own, matrix - np.diag(own)
