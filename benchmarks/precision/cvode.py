"""SUNDIALS CVODE, through scikit-sundae."""

from __future__ import annotations

import numpy as np
from sksundae.cvode import CVODE

from benchmarks.precision.equations import Equations
from benchmarks.precision.problems import Watched
from tests.reference.problem import Array


class Cvode:
    """Adams' or backward differentiation methods."""

    def __init__(self, problem: Watched, method: str) -> None:
        self._problem, self._method = problem, method
        self._equations = Equations(problem)

    def __call__(self, rtol: float) -> Array:
        """Run it."""
        equations = self._equations

        def rates(time: float, state: Array, into: Array) -> None:
            into[:] = equations.rates(time, state)

        solver = CVODE(
            rates,
            method=self._method,
            rtol=rtol,
            atol=rtol * 1e-3 * float(np.abs(equations.start).max()),
            max_num_steps=10_000_000,
        )
        instants = np.concatenate([[0.0], self._problem.times])
        solution = solver.solve(instants, equations.start)
        if not solution.success or len(solution.t) != len(instants):
            return np.full(len(self._problem.times), np.nan)
        found: Array = solution.y[1:, : equations.modes] @ self._problem.row
        return found
