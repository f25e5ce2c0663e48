"""All solvers of the comparison, each with its ladder."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator

import numpy as np

from benchmarks.precision.equations import Equations
from benchmarks.precision.ladders import Solver
from benchmarks.precision.problems import INSTANTS, Watched
from bumpstop import _core
from bumpstop.canonical import canonical_form
from bumpstop.methods import FIXED_STEP_METHODS, TOLERANCE_METHODS
from tests.reference.problem import Array

RUNGS = 9
TOLERANCES = tuple(10.0**-digits for digits in range(3, 14, 2))
LONGEST_TURN = 4.0
"""Angle in rad that the highest mode turns in the coarsest step where every step is stable."""


def solvers(problem: Watched) -> Iterator[Solver]:
    """Yield this program's methods, then those of others that are installed."""
    yield Solver("**exact**", (0.0,), lambda _: _own(problem, "exact"))
    for method in FIXED_STEP_METHODS:
        steps = _steps(problem, method)
        yield Solver(method, steps, _Stepped(problem, method), has_order=True)
    for method in TOLERANCE_METHODS:
        yield Solver(method, TOLERANCES, _Tolerant(problem, method))
    points = [1.0 / (50.0 * 2**rung) for rung in range(RUNGS)]
    name = "adaptive_central_difference"
    yield Solver(name, points, _Resolving(problem, name), has_order=True)
    for name in ("RK45", "DOP853", "LSODA"):
        yield Solver(f"SciPy {name}", TOLERANCES, _Scipy(problem, name))
    if importlib.util.find_spec("sksundae"):
        from benchmarks.precision.cvode import Cvode

        for method in ("BDF", "Adams"):
            yield Solver(f"CVODE, {method}", TOLERANCES, Cvode(problem, method))
    if importlib.util.find_spec("exudyn"):
        from benchmarks.precision.exudyn_alpha import GeneralizedAlpha

        steps = _steps(problem, "newmark")
        alpha = GeneralizedAlpha(problem)
        yield Solver("Exudyn generalised alpha", steps, alpha, has_order=True)
    if importlib.util.find_spec("openseespy"):
        from benchmarks.precision.opensees_newmark import Newmark, fits

        if fits(problem):
            steps = _steps(problem, "newmark")
            yield Solver("OpenSees Newmark", steps, Newmark(problem), has_order=True)


def _steps(problem: Watched, method: str) -> list[float]:
    """Return halved steps, from close to the stability limit or the highest frequency on."""
    form = canonical_form(problem.problem)
    highest = float(np.sqrt(problem.problem.basis.omega2.max()))
    limit = _core.stability_limit(form.system, form.laws, method, {})
    coarse = min(0.5 * limit, LONGEST_TURN / highest)
    duration = problem.problem.duration
    # A whole number of steps between two instants, so that none is read between steps.
    count = INSTANTS * int(np.ceil(duration / coarse / INSTANTS))
    return [duration / (count * 2**rung) for rung in range(RUNGS)]


def _own(problem: Watched, method: str, **options: float) -> Array:
    form = canonical_form(problem.problem)
    step, rtol, period = (options.get(name) for name in ("dt", "rtol", "part_of_period"))
    history = _core.simulate(
        form.system,
        form.laws,
        form.forcing,
        form.displacement,
        form.velocity,
        problem.problem.duration,
        method,
        step,
        tolerances=None if rtol is None else (rtol, None),
        parameters={"points_per_period": 1.0 / period} if period is not None else {},
    )
    return history.project(problem.row, problem.times, 0)


class _Stepped:
    """A method of this program with equal steps."""

    def __init__(self, problem: Watched, method: str) -> None:
        self._problem, self._method = problem, method

    def __call__(self, step: float) -> Array:
        """Run it."""
        return _own(self._problem, self._method, dt=step)


class _Tolerant:
    """A method of this program that follows a tolerance."""

    def __init__(self, problem: Watched, method: str) -> None:
        self._problem, self._method = problem, method

    def __call__(self, rtol: float) -> Array:
        """Run it."""
        return _own(self._problem, self._method, rtol=rtol)


class _Resolving:
    """A method of this program that takes a part of the shortest visible period as a step."""

    def __init__(self, problem: Watched, method: str) -> None:
        self._problem, self._method = problem, method

    def __call__(self, part_of_period: float) -> Array:
        """Run it."""
        return _own(self._problem, self._method, part_of_period=part_of_period)


class _Scipy:
    """``solve_ivp``, as it is called without thinking of switches."""

    def __init__(self, problem: Watched, method: str) -> None:
        self._problem, self._method = problem, method
        self._equations = Equations(problem)

    def __call__(self, rtol: float) -> Array:
        """Run it."""
        from scipy.integrate import solve_ivp

        equations = self._equations
        solution = solve_ivp(
            equations.rates,
            (0.0, self._problem.problem.duration),
            equations.start,
            method=self._method,
            t_eval=self._problem.times,
            rtol=max(rtol, 3e-14),
            atol=rtol * 1e-3 * float(np.abs(equations.start).max()),
        )
        found: Array = self._problem.row @ solution.y[: equations.modes]
        return found
