"""What every solver of the comparison offers: one run, its time, and the tip at the outputs."""

from typing import NamedTuple, Protocol

from tests.reference.problem import Array, StopProblem


class Run(NamedTuple):
    """One solution."""

    seconds: float
    tip: Array
    """Displacement ``row . q`` in m at the output times."""


class Solver(Protocol):
    """Something that solves a problem from the start, keeping nothing from the run before."""

    name: str

    def solve(self, problem: StopProblem, times: Array) -> Run:
        """Solve and say how long it took."""
        ...
