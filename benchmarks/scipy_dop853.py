"""SciPy's DOP853 with event location, as a Python user calls it."""

from time import perf_counter

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.solver import Run
from tests.reference.problem import Array, StopProblem


class ScipyDop853:
    """``solve_ivp`` on NumPy arrays, the distance as an event."""

    def __init__(self, rtol: float = 1e-9, atol: float = 1e-12) -> None:
        self.rtol, self.atol = rtol, atol
        self.name = f"SciPy DOP853, rtol = {rtol:.0e}"

    def solve(self, problem: StopProblem, times: Array) -> Run:
        """Integrate to the last output."""
        modes = problem.omega2.size

        def rates(_time: float, state: Array) -> Array:
            q, v = state[:modes], state[modes:]
            force = max(0.0, -problem.stiffness * float(problem.row @ q))
            acceleration = problem.row * force - problem.omega2 * q - problem.damping * v
            return np.concatenate([v, acceleration])

        def distance(_time: float, state: Array) -> float:
            return float(problem.row @ state[:modes])

        initial = np.concatenate([problem.displacement, problem.velocity])
        start = perf_counter()
        solution = solve_ivp(
            rates,
            (0.0, float(times[-1])),
            initial,
            method="DOP853",
            t_eval=times,
            events=distance,
            rtol=self.rtol,
            atol=self.atol,
        )
        return Run(perf_counter() - start, problem.row @ solution.y[:modes])
