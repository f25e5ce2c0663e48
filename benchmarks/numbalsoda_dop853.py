"""Runge-Kutta 8(5,3) of Hairer in Fortran with a right-hand side compiled by numba."""

from time import perf_counter
from typing import Any

import numba
import numpy as np
from numbalsoda import dop853, lsoda_sig

from benchmarks.solver import Run
from tests.reference.problem import Array, StopProblem

MODES = 10


def _fill(_time: float, state: Array, rates: Array, data: Array) -> None:
    """Fill in rates; data holds stiffness, omega2, damping, row; a fixed size lets loops unroll."""
    distance = 0.0
    for i in range(MODES):
        distance += data[1 + 2 * MODES + i] * state[i]
    force = -data[0] * distance if distance < 0.0 else 0.0
    for i in range(MODES):
        rates[i] = state[MODES + i]
        rates[MODES + i] = (
            data[1 + 2 * MODES + i] * force
            - data[1 + i] * state[i]
            - data[1 + MODES + i] * state[MODES + i]
        )


_rates: Any = numba.cfunc(lsoda_sig)(_fill)


class NumbalsodaDop853:
    """It locates no events: the step control meets the kink of the force unprepared."""

    def __init__(self, tolerance: float) -> None:
        self.tolerance = tolerance
        self.name = f"numbalsoda dop853, rtol = {tolerance:.0e}"

    def solve(self, problem: StopProblem, times: Array) -> Run:
        """Integrate from 0 through the output times."""
        start_state = np.concatenate([problem.displacement, problem.velocity])
        data = np.concatenate([[problem.stiffness], problem.omega2, problem.damping, problem.row])
        grid = np.concatenate([[0.0], times])
        start = perf_counter()
        states, success = dop853(
            _rates.address,
            start_state,
            grid,
            data,
            rtol=self.tolerance,
            atol=self.tolerance * 1e-3,
            mxstep=1_000_000,
        )
        seconds = perf_counter() - start
        if not success:
            raise ArithmeticError(f"dop853 did not reach the end at rtol {self.tolerance:.0e}")
        return Run(seconds, states[1:, : problem.omega2.size] @ problem.row)
