"""A step of central differences with 500 modes and 50 stops, beside the products it cannot avoid.

``python benchmarks/explicit_step.py [--modes N] [--stops M]``. A step has to bring the modes to the
stops and the forces back to the modes: two products of an M x N matrix with a vector, four M N
operations. Their rate is held against that of NumPy's product of the same matrix (BLAS, one
thread), measured in turns with the steps.
"""

import argparse
import os
import sys
from statistics import median
from time import process_time

os.environ.setdefault("OMP_NUM_THREADS", "1")  # before NumPy is imported

import numpy as np
from numpy.typing import NDArray

from bumpstop import _core

TURNS = 15
STEPS = 4000
PRODUCTS = 4000
LEAST_RATE = 0.5
"""Least part of the rate of matrix-vector products."""

Matrix = NDArray[np.float64]


class Rattling:
    """Modes of 1 to 100 Hz among stops that are hit now and then."""

    def __init__(self, modes: int, stops: int) -> None:
        random = np.random.default_rng(0)
        self.omega = 2.0 * np.pi * np.linspace(1.0, 100.0, modes)
        self.rows = random.standard_normal((stops, modes)) / np.sqrt(modes)
        self.velocity = random.standard_normal(modes)
        self.gaps = 0.002 * (1.0 + random.random(stops))
        self.dt = 0.1 / self.omega[-1]

    def run(self, steps: int) -> tuple[float, _core.History]:
        """Return the processor time of some steps, and what they gave."""
        still = np.zeros_like(self.omega)
        stops = [
            _core.Stop(row, gap, 1e3, 0.0) for row, gap in zip(self.rows, self.gaps, strict=True)
        ]
        system = _core.System(self.omega**2, 0.01 * self.omega)
        before = process_time()
        history = _core.simulate(
            system,
            stops,
            _core.Forcing(still),
            still,
            self.velocity,
            steps * self.dt,
            "central_difference",
            self.dt,
        )
        return process_time() - before, history

    def step(self) -> float:
        """Return the processor time of one step, what is made once left out."""
        few, _ = self.run(STEPS // 4)
        many, _ = self.run(STEPS)
        return (many - few) / (STEPS - STEPS // 4)

    def contacts(self) -> int:
        """Return how many contacts a run has."""
        _, history = self.run(STEPS)
        return sum(len(history.impacts(stop)["start"]) for stop in range(len(self.gaps)))


def seconds_of_product(matrix: Matrix, vector: Matrix) -> float:
    """Return the processor time of one product."""
    out = np.empty(len(matrix))
    before = process_time()
    for _ in range(PRODUCTS):
        np.dot(matrix, vector, out=out)
    return (process_time() - before) / PRODUCTS


def main() -> int:
    """Print both rates and their ratio; return 1 if it is missed."""
    parser = argparse.ArgumentParser(description="Time a step of central differences.")
    parser.add_argument("--modes", type=int, default=500)
    parser.add_argument("--stops", type=int, default=50)
    given = parser.parse_args()
    problem = Rattling(given.modes, given.stops)
    steps, products = [], []
    for _ in range(TURNS):
        steps.append(problem.step())
        products.append(seconds_of_product(problem.rows, problem.velocity))
    step, product = median(steps), median(products)
    rate = 2.0 * product / step
    operations = 2.0 * given.modes * given.stops
    print(f"{given.modes} modes, {given.stops} stops")
    print(f"{problem.contacts()} contacts in {STEPS} steps")
    print(f"one product {1e6 * product:.2f} us ({1e-9 * operations / product:.1f} Gflop/s)")
    print(f"one step {1e6 * step:.2f} us ({2e-9 * operations / step:.1f} Gflop/s)")
    verdict = "PASS" if rate >= LEAST_RATE else "MISS"
    print(f"{verdict}  rate of a step / rate of a product = {rate:.2f}, at least {LEAST_RATE}")
    return int(rate < LEAST_RATE)


if __name__ == "__main__":
    sys.exit(main())
