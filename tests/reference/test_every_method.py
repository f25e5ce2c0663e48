"""Every method runs the piecewise-linear cases of the manual, and converges at its order."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bumpstop as bs
from bumpstop import _core
from bumpstop.canonical import canonical_form
from bumpstop.methods import FIXED_STEP_METHODS, TOLERANCE_METHODS

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
CLOSE = {"rk32": 1e-4, "rk54": 1e-6, "dop853": 1e-6, "exprk43": 1e-6}


@cache
def solved(name: str, variant: str) -> bs.Response:
    problem = bs.load_case(CASES / name / "case.toml").problems[variant]
    return bs.simulate(problem, "exact")


def coarse_steps(problem: bs.Problem) -> int:
    """Return how many steps resolve the highest frequency with all stops closed."""
    form = canonical_form(problem)
    limit = _core.stability_limit(form.system, form.laws, "central_difference", {})
    return max(LEAST_STEPS, int(np.ceil(problem.duration / (PART_OF_LIMIT * limit))))


def error(name: str, variant: str, method: str, **options: Any) -> float:
    """Return the largest error of the modal displacements over the largest of them."""
    exact = solved(name, variant)
    run = bs.simulate(exact.problem, method, **options)
    times = np.linspace(0.0, exact.problem.duration, 101)
    found, true = (each.history.motion(times, 0) for each in (run, exact))
    return float(np.abs(found - true).max() / np.abs(true).max())


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


@pytest.mark.parametrize("method", TOLERANCE_METHODS)
@pytest.mark.parametrize(("name", "variant"), CASE_ORDERS)
def test_tolerances_are_kept(name: str, variant: str, method: str) -> None:
    assert error(name, variant, method, rtol=1e-8) < CLOSE[method]
