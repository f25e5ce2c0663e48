"""A step of an unreduced frame of 100,000 dofs with fifty stops, beside one solve with its factor.

``python benchmarks/full_model.py [--dofs N]``. The step is Newmark's; what it takes is told by the
progress of a run, so that what is made once does not count. The solve is that of the same matrix
with the same factor, by itself, before the run and after it. Both are processor times.
"""

import argparse
import sys
from pathlib import Path
from statistics import median
from time import process_time

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

import bumpstop as bs
from benchmarks.lattice import lattice, side_of
from bumpstop import _core
from bumpstop.full import full_problem, kept_dofs
from bumpstop.modal.full import FullModel
from bumpstop.structure.sparse import SparseMatrix

STOPS = 50
DT = 1e-3
STEPS = 320
SOLVES = 20
LARGEST_RATIO = 1.3


def frame(dofs: int) -> bs.Problem:
    """Return a frame that is pushed against stops at its roof."""
    side = side_of(dofs)
    roof = [f"N{x}_{y}_{side - 1}" for x in range(side) for y in range(side)]
    nodes = roof[:: max(1, len(roof) // STOPS)][:STOPS]
    stops = [
        bs.Stop(f"s{number}", node=node, normal=(-1, 0, 0), gap=1e-6 * number, stiffness=1e7)
        for number, node in enumerate(nodes)
    ]
    push = [bs.NodalForce(f"p{node}", node=node, force=(2e4, 0, 0)) for node in roof]
    model = FullModel.from_structure(lattice(dofs))
    return bs.Problem(model, laws=stops, loads=push, duration=STEPS * DT)


def step_matrix(problem: bs.Problem) -> SparseMatrix:
    """Return the matrix that a step of Newmark's solves with."""
    model = problem.basis
    assert isinstance(model, FullModel)
    mass, _, stiffness = model.matrices
    return mass.plus(stiffness.scaled(0.25 * DT**2))


def seconds_of_solve(factor: _core.SparseFactor, size: int) -> float:
    """Return the processor time of one solve."""
    rhs = np.random.default_rng(0).standard_normal((size, 1))
    times = []
    for _ in range(SOLVES):
        start = process_time()
        factor.solve(rhs)
        times.append(process_time() - start)
    return median(times)


def seconds_of_step(problem: bs.Problem) -> tuple[float, _core.History]:
    """Return the processor time of one step, and the run."""
    model = full_problem(problem, kept_dofs(problem, 1e6 * STEPS))
    seen: list[tuple[float, float]] = []
    history = model.simulate(
        "newmark", DT, False, {}, lambda part: seen.append((part * STEPS, process_time()))
    )
    steps, times = np.array(seen).T
    return float(np.polyfit(steps, times, 1)[0]), history


def main() -> int:
    """Print both times and their ratio; return 1 if it is missed."""
    parser = argparse.ArgumentParser(description="Time a step of an unreduced frame.")
    parser.add_argument("--dofs", type=int, default=100_000)
    problem = frame(parser.parse_args().dofs)
    matrix = step_matrix(problem)
    size = matrix.shape[0]
    print(f"{size} free dofs, {len(matrix.values)} entries, {len(problem.laws)} stops", flush=True)
    factor = _core.SparseFactor(matrix.arrays)
    before = seconds_of_solve(factor, size)
    step, history = seconds_of_step(problem)
    solve = 0.5 * (before + seconds_of_solve(factor, size))
    end = np.array([problem.duration])
    closed = sum(history.law_motion(law, end)[2][0] > 0.0 for law in range(len(problem.laws)))
    print(f"closed at the end: {closed}; energy residual {history.energy_residual():.1e}")
    print(f"one solve {1e3 * solve:.1f} ms, one step {1e3 * step:.1f} ms")
    ratio = step / solve
    print(f"{'PASS' if ratio <= LARGEST_RATIO else 'MISS'}  step / solve = {ratio:.2f}")
    return int(ratio > LARGEST_RATIO)


if __name__ == "__main__":
    sys.exit(main())
