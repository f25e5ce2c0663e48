"""Every method runs every piecewise-linear case of the manual, and converges at its order."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop import _core
from bumpstop.canonical import canonical_form
from bumpstop.methods import FIXED_STEP_METHODS, TOLERANCE_METHODS, check_method

CASES = Path(__file__).parents[2] / "cases"
CASE_ORDERS = {
    ("sdnl32", "stiff"): 2,
    ("sdnd100a", "published"): 1,  # friction's stick begins with a force that jumps
    ("sdnd101a", "exact"): 2,
    ("sdnd102a", "exact"): 2,
    ("sdnl104b", "exact"): 2,
    ("sdnl105b", "converged"): 2,
    ("sdnl111a", "exact"): 2,
    ("sdnd124b", "sampled"): 2,
}
"""Piecewise-linear cases, with the order that is left of any where steps pass over a switch."""
METHOD_ORDERS = {"symplectic_euler": 1}
"""Orders below two."""
FINER = 8
LEAST_STEPS = 400
PART_OF_LIMIT = 0.25


@cache
def solved(name: str, variant: str) -> bs.Response:
    problem = bs.load_case(CASES / name / "case.toml").problems[variant]
    return bs.simulate(problem, "exact")


def coarse_steps(problem: bs.Problem) -> int:
    """Return how many steps resolve the highest frequency with all stops closed."""
    form = canonical_form(problem)
    limit = _core.stability_limit(form.system, form.laws, "central_difference", {})
    return max(LEAST_STEPS, int(np.ceil(problem.duration / (PART_OF_LIMIT * limit))))


def distance(run: bs.Response, exact: bs.Response) -> float:
    """Return the largest error of the modal displacements over the largest of them."""
    times = np.linspace(0.0, exact.problem.duration, 101)
    found, true = (each.history.motion(times, 0) for each in (run, exact))
    return float(np.abs(found - true).max() / np.abs(true).max())


def error(name: str, variant: str, method: str, **options: Any) -> float:
    exact = solved(name, variant)
    return distance(bs.simulate(exact.problem, method, **options), exact)


@pytest.mark.parametrize("method", FIXED_STEP_METHODS)
@pytest.mark.parametrize(("name", "variant"), CASE_ORDERS)
def test_equal_steps_converge_at_their_order(name: str, variant: str, method: str) -> None:
    problem = solved(name, variant).problem
    steps = coarse_steps(problem)
    # Where a switch falls within its step moves the error: the larger of two counts.
    coarse, fine = (
        max(
            error(name, variant, method, dt=problem.duration / count)
            for count in (finer * steps, finer * steps * 4 // 3)
        )
        for finer in (1, FINER)
    )
    order = min(CASE_ORDERS[name, variant], METHOD_ORDERS.get(method, 2))
    assert np.log(coarse / fine) / np.log(FINER) > 0.8 * order
    assert fine < 2e-3


def takes(method: str, problem: bs.Problem) -> bool:
    try:
        check_method(method, problem)
    except bs.InputError:
        return False
    return True


def piecewise_linear() -> list[tuple[str, str]]:
    """Return the cases that the exact method takes, but no variant that repeats a problem."""
    found: dict[tuple[str, str], bs.Problem] = {}
    for path in sorted(CASES.glob("*/case.toml")):
        for variant, problem in bs.load_case(path).problems.items():
            if takes("exact", problem) and problem not in found.values():
                found[path.parent.name, variant] = problem
    return list(found)


PIECEWISE_LINEAR = piecewise_linear()
RTOL = 1e-8
LARGEST_ERROR = 1e-5
POINTS_PER_PERIOD = 1000.0


def own_methods(methods: Sequence[str], name: str, variant: str) -> list[str]:
    """Return those of some methods that take a case: of rigid stops `moreau_jean` at least."""
    problem = solved(name, variant).problem
    return [method for method in methods if takes(method, problem)]


@cache
def has_jumps(name: str, variant: str) -> bool:
    """Tell whether velocities or accelerations jump at a switch."""
    exact = solved(name, variant)
    duration = exact.problem.duration
    switches = np.array(exact.event_table()["time"])
    sides = [np.clip(switches + shift * duration, 0.0, duration) for shift in (-1e-9, 1e-9)]
    everywhere = np.linspace(0.0, duration, 1001)
    for derivative in (1, 2):
        before, after = (exact.history.motion(times, derivative) for times in sides)
        largest = np.abs(exact.history.motion(everywhere, derivative)).max()
        if np.any(np.abs(after - before) > 1e-3 * largest):
            return True
    return False


@cache
def shortest_time(name: str, variant: str) -> float:
    """Return the time in which the highest mode turns by two radians, all stops closed.

    Rigid bodies between rigid stops have none: theirs is that between two switches.
    """
    exact = solved(name, variant)
    form = canonical_form(exact.problem)
    limit = _core.stability_limit(form.system, form.laws, "central_difference", {})
    between = exact.problem.duration / (1 + exact.event_count)
    return limit if np.isfinite(limit) else between


@pytest.mark.parametrize(("name", "variant"), PIECEWISE_LINEAR)
def test_equal_steps_follow_every_case(name: str, variant: str) -> None:
    problem = solved(name, variant).problem
    dt = problem.duration / (FINER * coarse_steps(problem))
    part = dt / shortest_time(name, variant)
    best = 1 if has_jumps(name, variant) else 2
    methods = own_methods(FIXED_STEP_METHODS, name, variant)
    assert "moreau_jean" in methods
    for method in methods:
        order = min(best, METHOD_ORDERS.get(method, 2))
        bound = part if order == 1 else 10.0 * part**2
        assert error(name, variant, method, dt=dt) < bound, method


@pytest.mark.parametrize(("name", "variant"), PIECEWISE_LINEAR)
def test_tolerances_are_kept_in_every_case(name: str, variant: str) -> None:
    """Errors of single steps add up, each of which is a part of the largest motion at most."""
    exact = solved(name, variant)
    for method in own_methods(TOLERANCE_METHODS, name, variant):
        run = bs.simulate(exact.problem, method, rtol=RTOL)
        assert distance(run, exact) < min(run.steps * RTOL, LARGEST_ERROR), method


@pytest.mark.parametrize(("name", "variant"), PIECEWISE_LINEAR)
def test_points_a_period_are_kept_in_every_case(name: str, variant: str) -> None:
    turn = 2.0 * np.pi / POINTS_PER_PERIOD
    for method in own_methods(["adaptive_central_difference"], name, variant):
        options = {"points_per_period": POINTS_PER_PERIOD}
        assert error(name, variant, method, **options) < 10.0 * turn**2
