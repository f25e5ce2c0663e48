"""Compare a run of the core with the fifty-digit oracle, event by event and state by state."""

from dataclasses import dataclass
from decimal import localcontext
from typing import TYPE_CHECKING

import numpy as np

from .precise import DIGITS, PreciseSolution
from .problem import Array, StopProblem

if TYPE_CHECKING:
    from bumpstop._core import History

LARGEST_GROWTH = 1e3
SAMPLES = 24


@dataclass(frozen=True)
class Comparison:
    """Worst relative differences between the core and the oracle on one problem."""

    expected: list[tuple[str, str]]
    found: list[tuple[str, str]]
    event_error: float  # time difference times approach speed, over the largest displacement
    state_error: float  # displacement and velocity after every event and between, relative
    growth: float
    margin: float

    @property
    def same_events(self) -> bool:
        """Whether neither missed one nor invented one."""
        return self.expected == self.found


def core_events(history: "History") -> list[tuple[float, str, str]]:
    """Return the core's events as the oracles list them."""
    events = history.events()
    return list(zip(events["time"], events["before"], events["after"], strict=True))  # type: ignore[arg-type]  # columns of mixed types


def growth(problem: StopProblem, solution: PreciseSolution, times: Array) -> Array:
    """Return how much a perturbation of the initial state has grown, at each time.

    A second run starts 1e-25 beside the first; differences are relative to the largest
    displacement and velocity.
    """
    modes = problem.omega2.size
    displacement, velocity = solution.motion(times)
    sizes = np.abs(displacement).max() + 1e-300, np.abs(velocity).max() + 1e-300
    direction = np.random.default_rng(7).normal(size=2 * modes)
    direction /= np.linalg.norm(direction)
    nudge = np.concatenate([direction[:modes] * sizes[0], direction[modes:] * sizes[1]])
    neighbour = PreciseSolution(problem, nudge)
    grown = []
    for time in times:
        with localcontext(prec=DIGITS):
            pairs = zip(
                solution.exact_state(float(time)),
                neighbour.exact_state(float(time)),
                strict=True,
            )
            difference = [
                max(abs(float((b - a).scaleb(25))) for a, b in zip(left, right, strict=True))
                for left, right in pairs
            ]
        grown.append(max(d / s for d, s in zip(difference, sizes, strict=True)))
    return np.array(grown)


def compare(problem: StopProblem) -> Comparison:
    """Solve with both, up to where perturbations have grown a thousandfold."""
    solution = PreciseSolution(problem)
    grid = np.linspace(0.0, problem.duration, SAMPLES + 1)[1:]
    times = np.sort(np.concatenate([grid, [time for time, _, _ in solution.events]]))
    grown = np.maximum.accumulate(growth(problem, solution, times))
    usable = times[grown <= LARGEST_GROWTH]
    if usable.size < times.size:
        problem = problem.but(duration=float(usable[-1]) * (1 + 1e-9))
        solution = PreciseSolution(problem)
    return measured(problem, solution, usable, max(1.0, float(grown[: usable.size].max())))


def measured(
    problem: StopProblem, solution: PreciseSolution, times: Array, grown: float
) -> Comparison:
    """Run the core and compare."""
    history = problem.solve()
    expected, found = solution.events, core_events(history)
    displacement, velocity = solution.motion(times)
    reach, speed = np.abs(displacement).max(), np.abs(velocity).max()
    event_error = 0.0
    for (time, _, _), (other, _, _) in zip(expected, found, strict=False):
        rate = abs(float(solution.motion(np.array([time]))[1][0] @ problem.row))
        event_error = max(event_error, abs(time - other) * rate / reach)
    return Comparison(
        expected=[event[1:] for event in expected],
        found=[event[1:] for event in found],
        event_error=event_error,
        state_error=max(
            float(np.abs(history.motion(times, 0) - displacement).max() / reach),
            float(np.abs(history.motion(times, 1) - velocity).max() / speed),
        ),
        growth=grown,
        margin=float(solution.margin),
    )
