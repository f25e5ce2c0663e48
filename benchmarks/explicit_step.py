"""A step of central differences with 500 modes and 50 stops, beside the products it cannot avoid.

``python benchmarks/explicit_step.py [--modes N] [--stops M]``. A step has to bring the modes to the
stops and the forces back to the modes: two products of an M x N matrix with a vector, four M N
operations. Their rate is held against that of NumPy's product of the same matrix (BLAS, one
thread), measured in turns with the steps.
"""

import argparse
import os
import sys
from pathlib import Path
from statistics import median
from time import process_time

os.environ.setdefault("OMP_NUM_THREADS", "1")  # before NumPy is imported
sys.path.insert(0, str(Path(__file__).parents[1]))  # for the march

import numpy as np
from numpy.typing import NDArray

from benchmarks.explicit_march import ExplicitMarch
from bumpstop import _core

TURNS = 15
STEPS = 4000
PRODUCTS = 4000
LEAST_RATE = 0.5
"""Least part of the rate of matrix-vector products."""

Matrix = NDArray[np.float64]


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
    random = np.random.default_rng(0)
    rows = random.standard_normal((given.stops, given.modes)) / np.sqrt(given.modes)
    velocity = random.standard_normal(given.modes)
    gaps = 0.002 * (1.0 + random.random(given.stops))
    # They are hit now and then.
    stops = [_core.Stop(row, gap, 1e3, 0.0) for row, gap in zip(rows, gaps, strict=True)]
    march = ExplicitMarch(stops, velocity, damping=0.01, steps=STEPS)
    steps, products = [], []
    for _ in range(TURNS):
        steps.append(march.seconds_of_a_step())
        products.append(seconds_of_product(rows, velocity))
    step, product = median(steps), median(products)
    rate = 2.0 * product / step
    operations = 2.0 * given.modes * given.stops
    print(f"{given.modes} modes, {given.stops} stops")
    print(f"{march.contacts()[0]} contacts in {STEPS} steps")
    print(f"one product {1e6 * product:.2f} us ({1e-9 * operations / product:.1f} Gflop/s)")
    print(f"one step {1e6 * step:.2f} us ({2e-9 * operations / step:.1f} Gflop/s)")
    verdict = "PASS" if rate >= LEAST_RATE else "MISS"
    print(f"{verdict}  rate of a step / rate of a product = {rate:.2f}, at least {LEAST_RATE}")
    return int(rate < LEAST_RATE)


if __name__ == "__main__":
    sys.exit(main())
