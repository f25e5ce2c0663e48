"""simulate: the one way from a problem to a response."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from bumpstop import _core
from bumpstop.arguments import did_you_mean, finite, not_negative, one_of, positive
from bumpstop.canonical import CanonicalForm, canonical_form
from bumpstop.errors import ComputationError, InputError, ModellingWarning
from bumpstop.problem import Law, Problem
from bumpstop.response import Response

__all__ = ["METHODS", "simulate", "usable_options"]

FIXED_STEP_METHODS = ("symplectic_euler", "central_difference")
ADAPTIVE_METHODS = ("rk32", "rk54", "dop853")
METHODS = ("auto", "exact", *FIXED_STEP_METHODS, *ADAPTIVE_METHODS)
OPTIONS: dict[str, tuple[str, ...]] = {
    "auto": ("rtol", "atol"),
    "exact": (),
    **dict.fromkeys(FIXED_STEP_METHODS, ("dt", "beyond_stability_limit")),
    **dict.fromkeys(ADAPTIVE_METHODS, ("rtol", "atol")),
}
"""What each method can be told; ``"auto"`` has no use for it where it takes the exact one."""
LARGEST_RECORD = 4 * 2**30
"""Memory in bytes that the core gives to the steps of a run."""
LANES = 8
"""The core keeps the modes of a step in blocks of so many."""
RTOL = 1e-8
"""Relative tolerance of the adaptive methods where none is given."""
FINEST_RTOL = 1e-14
"""The finest relative tolerance: rounding rules below it."""
MOST_ENERGY = 1e200
"""Twice the energy, in J, above which products of motions leave the range of numbers."""


def simulate(
    problem: Problem,
    method: str = "auto",
    *,
    dt: float | None = None,
    beyond_stability_limit: bool = False,
    rtol: float | None = None,
    atol: float | None = None,
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
        wherever it applies, and ``"dop853"`` where a law is smooth. ``"rk32"``, ``"rk54"`` and
        ``"dop853"`` are Runge-Kutta pairs of order 3, 5 and 8 whose steps follow a tolerance;
        they locate every switch of a law. ``"symplectic_euler"`` (order 1) and
        ``"central_difference"`` (order 2) march in equal steps.
    dt
        Step in s of the fixed-step methods.
    beyond_stability_limit
        Allow a step above the method's stability limit.
    rtol
        Relative tolerance of the adaptive methods, if one is taken, 1e-8 where left out: the error
        of a step in each modal displacement and velocity over the largest that it has been so far.
    atol
        Absolute tolerance of the adaptive methods, in the units of the modal displacements and of
        their rates; where left out, displacements, or velocities, below a tenth of the
        largest among them are measured by that.
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
    chosen, reason = _choose(method, problem)
    if chosen == "exact" and method == "auto":
        rtol = atol = None
    beyond = beyond_stability_limit or None
    _check_options(chosen, unknown, dt=dt, beyond_stability_limit=beyond, rtol=rtol, atol=atol)
    _refuse_coupled_modes(chosen, problem)
    _refuse_rigid_stops(chosen, problem)
    _refuse_smooth_laws(chosen, problem)
    tolerances = _checked_tolerances(chosen, rtol, atol)
    for line in problem.warnings:
        warnings.warn(line, ModellingWarning, stacklevel=2)
    model = _model(chosen, problem)
    step = _checked_step(chosen, dt, problem.duration, model, beyond_stability_limit)
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
            progress,
        )
    except _core.CoreError as error:
        _blame_scale(chosen, problem, error)
        raise ComputationError(f"the {chosen} method could not finish: {error}") from error
    relative, absolute = tolerances or (None, None)
    told = {"dt": step, "rtol": relative, "atol": absolute}
    options = {name: value for name, value in told.items() if value is not None}
    return Response(problem, history, times=problem.times, method_reason=reason, options=options)


def usable_options(method: str, options: Mapping[str, object]) -> dict[str, Any]:
    """Return those options, among many, that a method takes."""
    return {key: value for key, value in options.items() if key in OPTIONS[method]}


def _blame_scale(method: str, problem: Problem, error: Exception) -> None:
    """Raise where a number out of scale is what the exact method stumbled over."""
    if method != "exact":
        return
    from bumpstop.scale import out_of_scale

    blamed = out_of_scale(problem)
    if blamed is not None:
        raise blamed from error


def _choose(method: str, problem: Problem) -> tuple[str, str]:
    """Return the method to take, and why."""
    if method != "auto":
        return method, "asked for"
    for law in problem.laws:
        reason = _smooth(law)
        if reason:
            return "dop853", f"{law.name!r} is not piecewise linear: {reason}"
    return "exact", "all laws are piecewise linear"


def _check_options(method: str, unknown: dict[str, object], **known: object) -> None:
    """Refuse what the method does not take. Known options are None where they are not given."""
    takes = (*OPTIONS[method], "progress")
    given = {name: value for name, value in known.items() if value is not None} | unknown
    for name in [name for name in given if name not in takes]:
        takers = [other for other, options in OPTIONS.items() if name in options]
        hint = f"it takes {', '.join(takes)}; {name} is for {' and '.join(takers)}"
        raise InputError(
            f"is no option of the {method} method",
            key=name,
            value=given[name],
            hint=hint if takers else did_you_mean(name, takes),
        )


def _refuse_coupled_modes(method: str, problem: Problem) -> None:
    """Raise for a scheme that carries each mode by itself where something couples them."""
    basis = problem.basis
    if method in FIXED_STEP_METHODS and (basis.couples or basis.gyroscopic is not None):
        raise InputError(
            "does not take modes that damping or gyroscopic forces couple",
            key="method",
            value=method,
            hint=f"the exact method and {', '.join(ADAPTIVE_METHODS)} do",
        )


def _refuse_rigid_stops(method: str, problem: Problem) -> None:
    """Raise for a scheme that goes by forces where speeds jump."""
    if method != "exact":
        for law in problem.laws:
            if hasattr(law, "restitution"):
                raise InputError(
                    f"does not take rigid stops such as {law.name!r}",
                    key="method",
                    value=method,
                    hint="the exact method does",
                )


def _refuse_smooth_laws(method: str, problem: Problem) -> None:
    """Raise for a method that goes by the matrices of laws where one has none."""
    if method in ADAPTIVE_METHODS:
        return
    for law in problem.laws:
        reason = _smooth(law)
        if reason:
            what = f"does not take {law.name!r}: {reason}"
            hint = f"{', '.join(ADAPTIVE_METHODS)} do"
            raise InputError(what, key="method", value=method, hint=hint)


def _smooth(law: Law) -> str:
    """Return why a law is not piecewise linear; nothing where it is."""
    reason: str = getattr(law, "smooth", "")
    return reason


def _checked_tolerances(
    method: str, rtol: float | None, atol: float | None
) -> tuple[float, float | None] | None:
    if method not in ADAPTIVE_METHODS:
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


def _checked_step(
    method: str, dt: float | None, duration: float, model: CanonicalForm, beyond_limit: bool
) -> float | None:
    if method not in FIXED_STEP_METHODS:
        return None
    limit = _core.stability_limit(model.system, model.laws, method)
    if dt is None:
        hint = f"stable up to {limit:.4g} s"
        raise InputError(f"the {method} method needs a step in s", key="dt", hint=hint)
    step = positive("dt", dt)
    if step > duration:
        hint = f"the duration is {duration:g} s"
        raise InputError("must not exceed the duration", key="dt", value=dt, hint=hint)
    most = _most_steps(len(model.displacement))
    if duration / step > most:
        what = f"makes {duration / step:.2g} steps, more than the {most:.2g} that memory holds"
        hint = f"take at least {duration / most:.3g} s"
        raise InputError(what, key="dt", value=dt, hint=hint)
    if step > limit and not beyond_limit:
        raise InputError(
            f"is above the stability limit of {limit:.6g} s of the {method} method",
            key="dt",
            value=dt,
            hint="take a smaller step, or ask for it with beyond_stability_limit",
        )
    return step


def _most_steps(modes: int) -> int:
    """Return how many steps of so many modes the core keeps, without those about both ends."""
    numbers = LANES * -(-modes // LANES)
    return LARGEST_RECORD // (8 * numbers) - 4
