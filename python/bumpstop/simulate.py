"""simulate: the one way from a problem to a response."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from bumpstop import _core
from bumpstop.arguments import boolean, finite, not_negative, one_of, positive
from bumpstop.canonical import CanonicalForm, canonical_form
from bumpstop.errors import ComputationError, InputError, ModellingWarning
from bumpstop.methods import (
    ASKED,
    FIXED_STEP_METHODS,
    METHODS,
    ONE_STEP_METHODS,
    RTOL,
    TOLERANCE_METHODS,
    check_method,
    check_options,
    checked_parameters,
    choose,
)
from bumpstop.problem import Problem
from bumpstop.response import Response

__all__ = ["simulate"]

LARGEST_RECORD = 4 * 2**30
"""Memory in bytes that the core gives to the steps of a run."""
LANES = 8
"""The core keeps the modes of a step in blocks of so many."""
CUBIC = 4
"""Coefficients in time of each number of a classical scheme's step."""
WORKS = 4
"""Numbers of a step beside those of the modes and of each law."""
FULL_WORKS = 2 * WORKS
"""The same for a full model, whose energies are kept too."""
FINEST_RTOL = 1e-14
"""The finest relative tolerance: rounding rules below it."""
LARGEST_RESIDUAL = 1e-6
"""Imbalance, relative to the largest energy, above which a motion of the exact method is wrong."""
MOST_ENERGY = 1e200
"""Twice the energy, in J, above which products of motions leave the range of numbers."""
MOST_MOTION = 1e100
"""Modal displacements, velocities and forces above which they do."""


class Stepping(NamedTuple):
    """A method with its parameters, whether its step may be unstable, and why it is taken."""

    method: str
    parameters: dict[str, float]
    beyond_limit: bool
    reason: str
    """Why it is taken."""


def simulate(
    problem: Problem,
    method: str = "auto",
    *,
    dt: float | None = None,
    beyond_stability_limit: bool = False,
    beta: float | None = None,
    gamma: float | None = None,
    alpha: float | None = None,
    spectral_radius: float | None = None,
    theta: float | None = None,
    points_per_period: float | None = None,
    rtol: float | None = None,
    atol: float | None = None,
    exact_flights: bool | None = None,
    progress: Callable[[float], None] | None = None,
    **unknown: object,
) -> Response:
    """Compute how the structure moves.

    Parameters
    ----------
    problem
        What to simulate.
    method
        ``"exact"`` solves each phase between two contacts in closed form; ``"auto"`` takes it
        wherever it applies, and where a law is smooth ``"dop853"``, or ``"exprk43"`` if the modes
        reach 1e4 times their lowest frequency. ``"rk32"``, ``"rk54"`` and
        ``"dop853"`` are Runge-Kutta pairs of order 3, 5 and 8 whose steps follow a tolerance,
        ``"exprk43"`` is one of order 4 for stiff modes; the steps of
        ``"adaptive_central_difference"`` (order 2) follow the frequency that the motion shows.
        All of these locate every switch of a law. The others march in equal steps:
        ``"symplectic_euler"`` (order 1), ``"central_difference"``, ``"newmark"``, ``"hht"``,
        ``"generalized_alpha"``, ``"trbdf2"``, ``"exponential"`` (order 2) and ``"devogelaere"``
        (order 4); ``"moreau_jean"`` steps over the impacts of rigid stops (order 1).
    dt
        Step in s of the fixed-step methods.
    beyond_stability_limit
        Allow a step above the method's stability limit.
    beta, gamma
        Weights of the end's acceleration in Newmark's displacement and velocity, 1/4 and 1/2
        where left out.
    alpha
        Of the method of Hilber, Hughes and Taylor, from -1/3 to 0, -0.05 where left out.
    spectral_radius
        Of generalised alpha: what a step leaves of the highest frequencies, from 0 to 1, 0.8 where
        left out.
    theta
        Weight of the end of a step in the method of Moreau and Jean, from 1/2 to 1, 1/2 where left
        out.
    points_per_period
        Steps of the adaptive central difference in a period of the fastest visible motion, from 20
        to 1e7, 50 where left out.
    rtol
        Relative tolerance of the Runge-Kutta pairs, if one is taken, 1e-8 where left out: the error
        of a step in each modal displacement and velocity over the largest that it has been so far.
    atol
        Absolute tolerance of the Runge-Kutta pairs, in the units of the modal displacements and of
        their rates; where left out, displacements, or velocities, below a tenth of the
        largest among them are measured by that.
    exact_flights
        Whether a method with tolerances leaves flights to the exact one, where some law keeps that
        from taking the whole problem: stretches of time in which no contact pushes and no smooth
        law acts. True where left out.
    progress
        Called with the fraction done, between 0 and 1, about ten times a second.
    unknown
        Refused, with what the method does take.

    Returns
    -------
    Response
        The motion, forces, impacts and energies; it can be sampled at any time.

    Raises
    ------
    InputError
        If the method is unknown or does not take an option that is given, or a step is
        missing, out of range or unstable.
    ComputationError
        If the computation could not be finished.

    Warns
    -----
    ModellingWarning
        Of each of the problem's ``warnings``.

    Examples
    --------
    A ball falls 1 m onto a spring; the instant of contact is sqrt(2 h / g).

    >>> import bumpstop as bs
    >>> basis = bs.ModalBasis.from_modes(frequency=[0], damping=[0], shapes={("P", "dz"): [1]})
    >>> floor = bs.Stop("floor", node="P", normal=(0, 0, 1), gap=1.0, stiffness=1e4)
    >>> weight = bs.NodalForce("weight", node="P", force=(0, 0, -9.81))
    >>> problem = bs.Problem(basis, laws=[floor], loads=[weight], duration=1.0)
    >>> response = bs.simulate(problem)
    >>> print(f"{response.impact_table()['start'][0]:.12f}")
    0.451523640986
    """
    if not isinstance(problem, Problem):
        hint = "of a case, take one of its problems"
        raise InputError("must be a Problem", key="problem", value=problem, hint=hint)
    one_of("method", method, METHODS)
    beyond_stability_limit = boolean("beyond_stability_limit", beyond_stability_limit)
    if progress is not None and not callable(progress):
        what, hint = "must be a function", "it is told the part that is done, from 0 to 1"
        raise InputError(what, key="progress", value=progress, hint=hint)
    chosen, reason = choose(method, problem)
    if chosen == "exact" and method == "auto":
        rtol = atol = exact_flights = None
    beyond = beyond_stability_limit or None
    of_scheme = {
        "beta": beta,
        "gamma": gamma,
        "alpha": alpha,
        "spectral_radius": spectral_radius,
        "theta": theta,
        "points_per_period": points_per_period,
    }
    of_tolerance = {"rtol": rtol, "atol": atol, "exact_flights": exact_flights}
    given = {"dt": dt, "beyond_stability_limit": beyond, **of_tolerance, **of_scheme}
    check_options(chosen, unknown, given)
    check_method(chosen, problem, by_auto=method == "auto")
    if exact_flights is not None:
        exact_flights = boolean("exact_flights", exact_flights)
    parameters = checked_parameters(chosen, of_scheme)
    tolerances = _checked_tolerances(chosen, rtol, atol)
    for line in problem.warnings:
        warnings.warn(line, ModellingWarning, stacklevel=2)
    stepping = Stepping(chosen, parameters, beyond_stability_limit, reason)
    if problem.basis.unreduced:
        return _run_full(problem, stepping, dt, progress)
    model = _model(chosen, problem)
    step = None
    if chosen in FIXED_STEP_METHODS:
        limit = _core.stability_limit(model.system, model.laws, chosen, parameters)
        step = _checked_step(stepping, dt, problem.duration, limit, _most_steps(chosen, model))
    try:
        history = _core.simulate(
            model.system,
            model.laws,
            model.forcing,
            model.displacement,
            model.velocity,
            problem.duration,
            chosen,
            step,
            beyond_stability_limit,
            tolerances,
            parameters,
            progress,
            exact_flights is not False,
            model.states,
        )
    except _core.CoreError as error:
        _blame_load(problem, error)
        _blame_scale(chosen, problem, error)
        raise ComputationError(f"the {chosen} method could not finish: {error}") from error
    if chosen == "exact":
        _check_outcome(problem, history)
    else:
        _check_numbers(chosen, problem, history)
    relative, absolute = tolerances or (None, None)
    told = {
        "dt": step,
        "rtol": relative,
        "atol": absolute,
        "exact_flights": exact_flights,
        **parameters,
    }
    options = {name: value for name, value in told.items() if value is not None}
    return Response(problem, history, instants=problem.grid, method_reason=reason, options=options)


def _check_outcome(problem: Problem, history: _core.History) -> None:
    """Refuse a motion of the exact method that is none: numbers out of scale have been lost.

    The ledger of loads that change in time takes many times as long as their run: it is looked at
    where some number of the problem is suspicious.
    """
    end = np.array([problem.duration])
    state = np.hstack([history.motion(end, order) for order in (0, 1)])
    what = ""
    if not np.abs(state).max() < MOST_MOTION:
        what = f"the motion leaves the range of numbers by t = {problem.duration:g} s"
    elif not _varies(problem) or _is_suspicious(problem):
        residual = history.energy_residual()
        if not residual <= LARGEST_RESIDUAL:
            what = (
                f"by t = {problem.duration:g} s the energy ledger is open by {residual:.1e} of "
                "the largest energy"
            )
    if what:
        error = ComputationError(
            f"the exact method lost its digits: {what}; check the units of all numbers, "
            "or take an adaptive method"
        )
        _blame_load(problem, error)
        _blame_scale("exact", problem, error)
        raise error


def _blame_load(problem: Problem, error: Exception) -> None:
    """Raise where a load is what a motion left the range of numbers for."""
    from bumpstop.scale import too_heavy

    blamed = too_heavy(problem)
    if blamed is not None:
        raise blamed from error


def _check_numbers(method: str, problem: Problem, history: _core.History) -> None:
    """Refuse a run that ends in what is no number: none may reach a file."""
    end = np.array([problem.duration])
    told = [history.motion(end, order) for order in (0, 1)]
    for law in range(len(problem.laws)):
        told.extend(history.law_motion(law, end))
    # Written so that what is no number is too large.
    if not all(np.abs(part).max(initial=0.0) < MOST_MOTION for part in told):
        error = ComputationError(
            f"the {method} method lost the motion by t = {problem.duration:g} s: it leaves the "
            "range of numbers; take a smaller step or tolerance, and check the units"
        )
        _blame_load(problem, error)
        raise error


def _varies(problem: Problem) -> bool:
    """Whether a load changes in time or an obstacle moves."""
    if problem.supports_move or any(getattr(law, "functions", ()) for law in problem.laws):
        return True
    parts = (part for load in problem.loads for part in load.components(problem.basis))
    return any(functions for _, functions in parts)


def _is_suspicious(problem: Problem) -> bool:
    from bumpstop.scale import out_of_scale

    return out_of_scale(problem) is not None


def _blame_scale(method: str, problem: Problem, error: Exception) -> None:
    """Raise where a number out of scale is what the exact method stumbled over."""
    if method != "exact":
        return
    from bumpstop.scale import out_of_scale, too_stiff

    blamed = too_stiff(problem) or out_of_scale(problem)
    if blamed is not None:
        raise blamed from error


def _checked_tolerances(
    method: str, rtol: float | None, atol: float | None
) -> tuple[float, float | None] | None:
    if method not in TOLERANCE_METHODS:
        return None
    relative = RTOL if rtol is None else finite("rtol", rtol)
    if not FINEST_RTOL <= relative < 1.0:
        what = f"must be from {FINEST_RTOL:g} to below 1"
        hint = "finer ones are lost in rounding"
        raise InputError(what, key="rtol", value=rtol, hint=hint)
    return relative, None if atol is None else not_negative("atol", atol)


def _model(method: str, problem: Problem) -> CanonicalForm:
    try:
        model = canonical_form(problem)
    except (_core.CoreError, FloatingPointError) as error:
        _blame_scale(method, problem, error)
        raise InputError(str(error), key="problem") from error
    with np.errstate(over="ignore"):
        energy = model.velocity @ model.velocity
    if not energy < MOST_ENERGY:
        raise InputError("moves too fast to compute with", key="initial", hint="check the units")
    return model


def _run_full(
    problem: Problem,
    stepping: Stepping,
    dt: float | None,
    progress: Callable[[float], None] | None,
) -> Response:
    """Step through time on the dofs of a structure."""
    from bumpstop.full import full_problem, kept_dofs

    method, parameters, beyond, reason = stepping
    steps = problem.duration / positive("dt", dt) if dt is not None else 1.0
    kept = kept_dofs(problem, steps)
    try:
        model = full_problem(problem, kept)
        limit = model.stability_limit(method, parameters)
    except _core.CoreError as error:
        raise InputError(str(error), key="problem") from error
    most = LARGEST_RECORD // (8 * CUBIC * (2 * len(kept) + FULL_WORKS + len(problem.laws)))
    step = _checked_step(stepping, dt, problem.duration, limit, most)
    try:
        history = model.simulate(method, step, beyond, parameters, progress)
    except _core.CoreError as error:
        _blame_load(problem, error)
        what = f"the {method} method could not finish: {error}"
        dof = getattr(error, "dof", None)
        if dof is not None:
            what += f"; dof {dof + 1} is {problem.basis.labels[dof]}"
        raise ComputationError(what) from error
    _check_numbers(method, problem, history)
    whole = len(kept) == len(problem.basis.omega2)
    return Response(
        problem,
        history,
        instants=problem.grid,
        method_reason=reason,
        options={"dt": step, **parameters},
        kept=None if whole else kept,
    )


def _checked_step(
    stepping: Stepping, dt: float | None, duration: float, limit: float, most: int
) -> float:
    method = stepping.method
    if dt is None:
        hint = f"stable up to {limit:.4g} s" if limit < math.inf else "every step is stable"
        took = "" if stepping.reason == ASKED else f", which auto took ({stepping.reason}),"
        raise InputError(f"the {method} method{took} needs a step in s", key="dt", hint=hint)
    step = positive("dt", dt)
    if step > duration:
        hint = f"the duration is {duration:g} s"
        raise InputError("must not exceed the duration", key="dt", value=dt, hint=hint)
    if duration / step > most:
        what = f"makes {duration / step:.2g} steps, more than the {most:.2g} that memory holds"
        hint = f"take at least {duration / most:.3g} s"
        raise InputError(what, key="dt", value=dt, hint=hint)
    if step > limit and not stepping.beyond_limit:
        raise InputError(
            f"is above the stability limit of {limit:.6g} s of the {method} method",
            key="dt",
            value=dt,
            hint="take a smaller step, or ask for it with beyond_stability_limit",
        )
    return step


def _most_steps(method: str, model: CanonicalForm) -> int:
    """Return how many steps the core keeps, without those about both ends."""
    modes = len(model.displacement)
    numbers = LANES * -(-modes // LANES)
    if method in ONE_STEP_METHODS:
        numbers = CUBIC * (2 * modes + WORKS + len(model.laws))
    return LARGEST_RECORD // (8 * numbers) - 4
