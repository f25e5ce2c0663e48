"""The methods of bumpstop's own core, timed by the core itself."""

from benchmarks.solver import Run
from tests.reference.problem import Array, StopProblem


class Core:
    """One method. Each run makes its system anew, so that no spectrum is kept."""

    def __init__(self, method: str, dt: float | None = None, ledger: bool = False) -> None:
        self.method, self.dt, self.ledger = method, dt, ledger
        self.name = f"bumpstop {method.replace('_', ' ')}"
        if dt is not None:
            self.name += f", dt = {dt:.0e} s"
        if ledger:
            self.name += " + energy ledger"

    def solve(self, problem: StopProblem, times: Array) -> Run:
        """Solve and read the outputs, and the ledger with its residual if asked for."""
        history = problem.solve(self.method, self.dt)
        tip = history.project(problem.row, times, 0)
        if self.ledger:
            history.energy_residual()
        return Run(history.seconds, tip)
