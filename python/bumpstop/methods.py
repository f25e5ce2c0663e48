"""The methods by name, what each can be told, and what it does not take."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from bumpstop.arguments import did_you_mean, finite
from bumpstop.errors import InputError
from bumpstop.problem import Law, Problem

__all__ = [
    "ADAPTIVE_METHODS",
    "ASKED",
    "FIXED_STEP_METHODS",
    "FULL_METHODS",
    "METHODS",
    "ONE_STEP_METHODS",
    "OPTIONS",
    "PARAMETERS",
    "POINTS_PER_PERIOD",
    "RTOL",
    "TOLERANCE_METHODS",
    "changing_speed",
    "check_method",
    "check_options",
    "checked_parameters",
    "choose",
    "smoothness",
    "usable_options",
]


ASKED = "asked for"
"""Why a method is taken that was not left open."""


class Range(NamedTuple):
    """What a parameter of a scheme may be."""

    least: float
    most: float


EXPLICIT_METHODS = ("symplectic_euler", "central_difference")
"""Marches that keep displacements alone."""
ONE_STEP_PARAMETERS: dict[str, dict[str, Range]] = {
    "newmark": {"beta": Range(0.0, 1.0), "gamma": Range(0.5, 1.0)},
    "hht": {"alpha": Range(-1.0 / 3.0, 0.0)},
    "generalized_alpha": {"spectral_radius": Range(0.0, 1.0)},
    "trbdf2": {},
    "devogelaere": {},
    "exponential": {},
    "moreau_jean": {"theta": Range(0.5, 1.0)},
}
"""Classical schemes of one step, with the parameters of each."""
ONE_STEP_METHODS = tuple(ONE_STEP_PARAMETERS)
FIXED_STEP_METHODS = (*EXPLICIT_METHODS, *ONE_STEP_METHODS)
TOLERANCE_METHODS = ("rk32", "rk54", "dop853", "exprk43")
"""Methods whose steps follow a tolerance."""
ADAPTIVE_METHODS = (*TOLERANCE_METHODS, "adaptive_central_difference")
"""Methods whose steps follow the motion, and that locate every switch."""
PARAMETERS: dict[str, dict[str, Range]] = {
    **ONE_STEP_PARAMETERS,
    "adaptive_central_difference": {"points_per_period": Range(20.0, 1e7)},
}
"""Parameters of the methods that have any beside a step or a tolerance."""
METHODS = ("auto", "exact", *FIXED_STEP_METHODS, *ADAPTIVE_METHODS)
OPTIONS: dict[str, tuple[str, ...]] = {
    "auto": ("rtol", "atol", "exact_flights"),
    "exact": (),
    **dict.fromkeys(FIXED_STEP_METHODS, ("dt", "beyond_stability_limit")),
    **{
        name: ("dt", "beyond_stability_limit", *known)
        for name, known in ONE_STEP_PARAMETERS.items()
    },
    **dict.fromkeys(TOLERANCE_METHODS, ("rtol", "atol", "exact_flights")),
    "adaptive_central_difference": ("points_per_period",),
}
"""What each method can be told; ``"auto"`` has no use for it where it takes the exact one."""
POINTS_PER_PERIOD = 50.0
"""Steps of the adaptive central difference in a period where none are given."""
RTOL = 1e-8
"""Relative tolerance where none is given."""
FULL_METHODS = ("newmark", "hht", "generalized_alpha", "central_difference")
"""Methods that take a full model, which is not reduced to modes."""
RIGID_METHODS = ("exact", "moreau_jean")
"""Methods that take rigid stops, at which velocities jump."""
STIFF = 1e4
"""Highest over lowest frequency from which explicit steps would follow modes that hardly move.

Measured on 2 to 32 modes with a Hertz contact, a cubic spring and a plastic one: ``exprk43`` takes
three to eight times as long as ``dop853`` at ratios of 4 to 20, 0.7 to 1.7 times at 2e3, 0.15 to
0.7 times at 2e4 and 0.08 to 0.3 times at 2e5."""
MODE_BY_MODE = ("central_difference", "devogelaere", "exponential")
"""Methods that carry each mode by itself."""


def check_method(method: str, problem: Problem, *, by_auto: bool = False) -> None:
    """Raise where a method, which ``"auto"`` may have taken, does not take the problem."""
    try:
        for refuse in (
            _refuse_full_model,
            _refuse_coupled_modes,
            _refuse_changing_speed,
            _refuse_rigid_stops,
            _refuse_rigid_friction,
            _refuse_stepped_laws,
            _refuse_smooth_laws,
        ):
            refuse(method, problem)
    except InputError as error:
        if not by_auto:
            raise
        what = f"auto finds none: {method} {error.what}"
        raise InputError(what, key=error.key, hint=error.hint) from None


def check_options(method: str, unknown: Mapping[str, object], known: Mapping[str, object]) -> None:
    """Refuse what the method does not take. Known options are None where they are not given."""
    takes = (*OPTIONS[method], "progress")
    given = {name: value for name, value in known.items() if value is not None} | dict(unknown)
    for name in [name for name in given if name not in takes]:
        takers = [other for other, options in OPTIONS.items() if name in options]
        hint = f"it takes {', '.join(takes)}; {name} is for {' and '.join(takers)}"
        raise InputError(
            f"is no option of the {method} method",
            key=name,
            value=given[name],
            hint=hint if takers else did_you_mean(name, takes),
        )


def checked_parameters(method: str, given: Mapping[str, float | None]) -> dict[str, float]:
    """Return the parameters of a scheme that are given, each within its range."""
    parameters = {}
    for name, (least, most) in PARAMETERS.get(method, {}).items():
        if given[name] is None:
            continue
        value = finite(name, given[name])
        if not least <= value <= most:
            what = f"must be from {least:.6g} to {most:.6g}"
            raise InputError(what, key=name, value=value, hint=f"for the {method} method")
        parameters[name] = value
    return parameters


def smoothness(law: Law) -> str:
    """Return why a law is not piecewise linear; nothing where it is."""
    reason: str = getattr(law, "smooth", "")
    return reason


def choose(method: str, problem: Problem) -> tuple[str, str]:
    """Return the method to take where ``"auto"`` is asked for, or the one that is, and why."""
    if method != "auto":
        return method, ASKED
    if problem.basis.unreduced:
        return "newmark", "a full model is stepped through time"
    turning = changing_speed(problem)
    for law in problem.laws:
        reason = smoothness(law)
        if reason:
            why = f"{law.name!r} is not piecewise linear: {reason}"
            reach = _reach(problem)
            if reach >= STIFF and turning is None:
                return (
                    "exprk43",
                    f"{why}; and the modes reach {reach:.0e} times the lowest frequency",
                )
            return "dop853", why
    if turning is not None:
        return "dop853", f"{turning} changes in speed"
    return "exact", "all laws are piecewise linear"


def _reach(problem: Problem) -> float:
    """Return the highest over the lowest frequency of modes that have one, if none are coupled."""
    basis = problem.basis
    frequencies = np.sqrt(np.abs(basis.omega2[basis.omega2 != 0.0]))
    if basis.couples or basis.gyroscopic is not None or not len(frequencies):
        return 1.0
    return float(frequencies.max() / frequencies.min())


def usable_options(method: str, options: Mapping[str, object], problem: Problem) -> dict[str, Any]:
    """Return those options, among many, that a method takes; ``"auto"`` as it does the problem."""
    chosen, _ = choose(method, problem)
    return {key: value for key, value in options.items() if key in OPTIONS[chosen]}


def _refuse_full_model(method: str, problem: Problem) -> None:
    """Raise for a method that goes by modes where there are none."""
    if problem.basis.unreduced and method not in FULL_METHODS:
        raise InputError(
            "does not take a full model",
            key="method",
            value=method,
            hint=f"{', '.join(FULL_METHODS)} do; the others need a modal basis",
        )


def _refuse_coupled_modes(method: str, problem: Problem) -> None:
    """Raise for a scheme that carries each mode by itself where something couples them."""
    basis = problem.basis
    if method in MODE_BY_MODE and (basis.couples or basis.gyroscopic is not None):
        raise InputError(
            "does not take modes that damping or gyroscopic forces couple",
            key="method",
            value=method,
            hint=f"the exact method, symplectic_euler and {', '.join(ADAPTIVE_METHODS)} do",
        )


def _refuse_changing_speed(method: str, problem: Problem) -> None:
    """Raise for methods whose matrices must not change where a shaft's speed does."""
    turning = changing_speed(problem)
    if turning is not None and method not in ADAPTIVE_METHODS:
        raise InputError(
            f"does not take speeds that change, as that of {turning}",
            key="method",
            value=method,
            hint=f"{', '.join(ADAPTIVE_METHODS)} do",
        )


def changing_speed(problem: Problem) -> str | None:
    """Return what turns at a speed that changes, in words; None where nothing does."""
    if problem.rotation is None and not any(hasattr(load, "rotation") for load in problem.loads):
        return None
    from bumpstop.turning import changing_shaft

    return changing_shaft(problem)


def _refuse_rigid_stops(method: str, problem: Problem) -> None:
    """Raise for a scheme that goes by forces where speeds jump."""
    if method not in RIGID_METHODS:
        for law in problem.laws:
            if hasattr(law, "restitution"):
                smooth = any(smoothness(each) for each in problem.laws)
                both = f"{' and '.join(RIGID_METHODS)} do"
                raise InputError(
                    f"does not take rigid stops such as {law.name!r}",
                    key="method",
                    value=method,
                    hint="moreau_jean with a step dt does" if smooth else both,
                )


def _refuse_rigid_friction(method: str, problem: Problem) -> None:
    """Raise for the exact method, whose impacts know the impulse along the normal alone."""
    if method != "moreau_jean":
        for law in problem.laws:
            rubs = getattr(law, "friction", None) is not None
            if hasattr(law, "restitution") and rubs:
                raise InputError(
                    f"does not take friction at rigid stops, as {law.name!r} has it",
                    key="method",
                    value=method,
                    hint="moreau_jean with a step dt does, or give the stop a stiffness",
                )


def _refuse_stepped_laws(method: str, problem: Problem) -> None:
    """Raise where a law is to be asked once a step, by a method that asks more."""
    if method == "symplectic_euler":
        return
    for law in problem.laws:
        if getattr(law, "stepped", False):
            what = f"does not take {law.name!r}, which is asked once a step: {smoothness(law)}"
            hint = "symplectic_euler with a step dt does"
            raise InputError(what, key="method", value=method, hint=hint)


def _refuse_smooth_laws(method: str, problem: Problem) -> None:
    """Raise for the exact method, which asks laws for matrices, where one has none.

    Implicit schemes refuse laws with rate equations of their own, explicit ones those of them that
    switch by what they remember.
    """
    if method in ADAPTIVE_METHODS:
        return
    for law in problem.laws:
        reason = smoothness(law)
        explicit = EXPLICIT_METHODS if getattr(law, "flows_in_steps", False) else ()
        flows = getattr(law, "flows", False) and method not in explicit
        if reason and (method == "exact" or flows):
            what = f"does not take {law.name!r}: {reason}"
            hint = f"{', '.join((*explicit, *ADAPTIVE_METHODS))} do"
            raise InputError(what, key="method", value=method, hint=hint)
