"""Speed and error of the exact method on SDNL32 beside other solvers, in one run.

Run ``make bench``. Errors are those of the tip at twenty outputs against fifty-digit arithmetic,
relative to the largest displacement; times are medians, of random problems each solved once or
of a published one solved again and again. Solvers take turns, so that a busy machine slows all.
"""

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))  # the oracle lives among the tests

from benchmarks.core_methods import Core
from benchmarks.numba_central_difference import NumbaCentralDifference
from benchmarks.numbalsoda_dop853 import NumbalsodaDop853
from benchmarks.scipy_dop853 import ScipyDop853
from benchmarks.sdnl32_problems import TIMES, published, random_cases
from benchmarks.solver import Solver
from tests.reference.precise import PreciseSolution
from tests.reference.problem import Array, StopProblem

STEP = 1e-5
ROUNDS = 10
REFERENCES = 10
EQUAL_ERROR = 1e-13  # rounding, for a method of a thousand steps
REQUIRED_ERROR = 1e-12
TOLERANCES = [10.0**-digits for digits in range(6, 16)]


@dataclass(frozen=True)
class Entry:
    """A solver, and how many of ten thousand runs it gets."""

    solver: Solver
    share: float


@dataclass(frozen=True)
class Result:
    """What one solver did on one set of problems."""

    name: str
    seconds: float
    error: float


def references(problems: Sequence[StopProblem]) -> list[Array]:
    """Return the tip at the outputs from the fifty-digit oracle."""
    return [PreciseSolution(p).motion(TIMES)[0] @ p.row for p in problems]


def error(solver: Solver, problems: Sequence[StopProblem], tips: Sequence[Array]) -> float:
    """Return the worst error relative to the largest displacement."""
    return max(
        float(np.abs(solver.solve(problem, TIMES).tip - tip).max() / np.abs(tip).max())
        for problem, tip in zip(problems, tips, strict=True)
    )


def loosest(limit: float, problems: Sequence[StopProblem], tips: Sequence[Array]) -> Solver:
    """Return dop853 at the loosest tolerance whose error is below a limit."""
    for tolerance in TOLERANCES:
        solver = NumbalsodaDop853(tolerance)
        if error(solver, problems, tips) <= limit:
            return solver
    raise ArithmeticError(f"dop853 reaches {limit:.0e} at no tolerance")


def take_turns(entries: Sequence[Entry], problems: Sequence[StopProblem]) -> list[float]:
    """Return each solver's median time over its share of the problems."""
    seconds: list[list[float]] = [[] for _ in entries]
    for chunk in range(ROUNDS):
        batch = problems[chunk::ROUNDS]
        for entry, times in zip(entries, seconds, strict=True):
            count = max(1, round(len(batch) * entry.share))
            times.extend(entry.solver.solve(problem, TIMES).seconds for problem in batch[:count])
    return [median(times) for times in seconds]


def measure(
    entries: dict[str, Entry], problems: Sequence[StopProblem], runs: int
) -> dict[str, Result]:
    """Return times and errors on a set of problems, repeated up to a number of runs."""
    known = problems[:REFERENCES]
    tips = references(known)
    # The first solutions also compile what numba compiles.
    errors = [error(entry.solver, known, tips) for entry in entries.values()]
    repeated = [problems[i % len(problems)] for i in range(runs)]
    seconds = take_turns(list(entries.values()), repeated)
    return {
        role: Result(entry.solver.name, time, worst)
        for (role, entry), time, worst in zip(entries.items(), seconds, errors, strict=True)
    }


def show(title: str, results: dict[str, Result]) -> None:
    """Print one table."""
    ours = results["exact"].seconds
    print(f"\n{title:58}{'time us':>12}{'ratio':>10}{'error':>12}")
    for result in results.values():
        print(
            f"{result.name:58}{1e6 * result.seconds:12.2f}{result.seconds / ours:10.2f}"
            f"{result.error:12.1e}"
        )
    print()


def judge(title: str, results: dict[str, Result]) -> bool:
    """Print each target with what was reached, and return whether all were."""
    seconds = {role: result.seconds for role, result in results.items()}
    exact = seconds["exact"]
    loop = min(seconds["loop"], seconds["fast loop"])
    targets = [
        ("error of the exact method, at most 1e-12", results["exact"].error, REQUIRED_ERROR),
        ("exact / numba loop, at most 1/4", exact / loop, 1 / 4),
        ("exact / dop853 at equal error, at most 1/100", exact / seconds["equal"], 1 / 100),
        ("exact / SciPy DOP853, at most 1/5000", exact / seconds["scipy"], 1 / 5000),
        # Ours adds in a fixed order, as numba does without fastmath.
        (
            "own central difference / numba loop of the same arithmetic, at most 1.15",
            seconds["own loop"] / seconds["loop"],
            1.15,
        ),
    ]
    for name, reached, limit in targets:
        figure = f"1/{1 / reached:.1f}" if limit < 1 < 1 / reached < 1e6 else f"{reached:.2g}"
        print(f"{'PASS' if reached <= limit else 'MISS'}  {title}: {name}: {figure}")
    return all(reached <= limit for _, reached, limit in targets)


def lineup(equal: Solver) -> dict[str, Entry]:
    """Return all solvers by their role in the targets."""
    return {
        "exact": Entry(Core("exact"), 1.0),
        "ledger": Entry(Core("exact", ledger=True), 1.0),
        "own loop": Entry(Core("central_difference", STEP), 0.2),
        "euler": Entry(Core("symplectic_euler", STEP), 0.2),
        "loop": Entry(NumbaCentralDifference(STEP, fastmath=False), 1.0),
        "fast loop": Entry(NumbaCentralDifference(STEP, fastmath=True), 1.0),
        "equal": Entry(equal, 0.02),
        "scipy": Entry(ScipyDop853(), 0.0),
    }


def main() -> int:
    """Measure the published problems and the random ones; return 1 if a target was missed."""
    parser = argparse.ArgumentParser(description="Time the exact method on SDNL32 beside others.")
    parser.add_argument("--cases", type=int, default=10_000, help="number of random problems")
    count = parser.parse_args().cases
    soft, stiff = published()
    drawn = random_cases(count)
    known = [soft, stiff, *drawn[:REFERENCES]]
    entries = lineup(loosest(EQUAL_ERROR, known, references(known)))
    passed = True
    for title, problems in (
        ("k = 18 kN/m", [soft]),
        ("k = 45 kN/m", [stiff]),
        (f"{count} random problems", drawn),
    ):
        results = measure(entries, problems, count)
        show(title, results)
        passed = judge(title, results) and passed
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
