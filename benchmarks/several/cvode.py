"""SUNDIALS CVODE with its root finding, through scikit-sundae."""

from time import perf_counter
from typing import Any

import numpy as np
from sksundae.cvode import CVODE

from benchmarks.several.contacts import Contacts
from benchmarks.several.equations import Equations
from tests.reference.problem import Array
from tests.reference.several.problem import SeveralStops


class Cvode:
    """Adams' methods with an exact Jacobian; roots are signs that differ at the ends of a step."""

    def __init__(self, rtol: float) -> None:
        self.rtol = rtol
        self.name = f"SUNDIALS CVODE, rtol = {rtol:.0e}"

    def find(self, problem: SeveralStops) -> Contacts:
        """Integrate over the run; roots are recorded and do not stop it."""
        equations, stops = Equations.of(problem), len(problem.stops)

        def rates(_time: float, state: Array, into: Array) -> None:
            into[:] = equations.rates(state)

        def jacobian(_time: float, state: Array, _rates: Array, into: Array) -> None:
            into[:] = equations.jacobian(state)

        def distances(_time: float, state: Array, into: Array) -> None:
            into[:] = equations.distances(state)

        events: Any = distances
        events.terminal, events.direction = [False] * stops, [-1] * stops
        start = perf_counter()
        solver = CVODE(
            rates,
            method="Adams",
            rtol=self.rtol,
            atol=self.rtol * 1e-3 * float(np.abs(problem.velocity).max()),
            jacfn=jacobian,
            eventsfn=events,
            num_events=stops,
            max_num_steps=10_000_000,
        )
        initial = np.concatenate([problem.displacement, problem.velocity])
        solution = solver.solve(np.array([0.0, problem.duration]), initial)
        seconds = perf_counter() - start
        if not solution.success:
            raise ArithmeticError(f"CVODE did not reach the end: {solution.message}")
        closings: list[list[float]] = [[] for _ in range(stops)]
        if solution.t_events is not None:
            for time, which in zip(solution.t_events, solution.i_events, strict=True):
                for number in np.flatnonzero(which):
                    closings[number].append(float(time))
        return Contacts(seconds, closings)
