"""SciPy's Runge-Kutta methods with an event function for each stop."""

from collections.abc import Callable
from time import perf_counter

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.several.contacts import Contacts
from benchmarks.several.equations import Equations
from tests.reference.problem import Array
from tests.reference.several.problem import SeveralStops


class ScipyEvents:
    """``solve_ivp``; it looks for a change of sign between the ends of its steps."""

    def __init__(self, method: str, rtol: float) -> None:
        self.method, self.rtol = method, rtol
        self.name = f"SciPy {method}, rtol = {rtol:.0e}"

    def find(self, problem: SeveralStops) -> Contacts:
        """Integrate over the run; events are recorded and do not stop it."""
        equations = Equations.of(problem)

        def distance(number: int) -> Callable[[float, Array], float]:
            row, gap, n = equations.rows[number], equations.gaps[number], equations.modes

            def event(_time: float, state: Array) -> float:
                return float(gap + row @ state[:n])

            event.direction = -1  # type: ignore[attr-defined]  # as SciPy wants it
            return event

        start = perf_counter()
        solution = solve_ivp(
            lambda _time, state: equations.rates(state),
            (0.0, problem.duration),
            np.concatenate([problem.displacement, problem.velocity]),
            method=self.method,
            events=[distance(number) for number in range(len(problem.stops))],
            rtol=self.rtol,
            atol=self.rtol * 1e-3 * float(np.abs(problem.velocity).max()),
        )
        seconds = perf_counter() - start
        return Contacts(seconds, [list(times) for times in solution.t_events])
