"""A step with 100 modes and 20 stops with friction, beside the products it cannot avoid.

``python benchmarks/friction.py [--modes N] [--stops M]``. A step of central differences has to
bring the modes to the stops, along the normal and along the obstacle, and the forces back to the
modes: two products of a 2M x N matrix with a vector. NumPy takes the same ones (BLAS, one thread),
in turns with the steps; what it takes to call them from Python is left out.
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
STEPS = 20_000
PRODUCTS = 20_000
MOST = 1.5
"""Largest time of a step, by that of its two products."""

Matrix = NDArray[np.float64]


def seconds_of_products(matrix: Matrix, vector: Matrix) -> float:
    """Return the processor time of both products, without that of calling them from Python."""
    few = np.ones((1, 1))
    return _both(matrix, vector) - _both(few, few[0])


def _both(matrix: Matrix, vector: Matrix) -> float:
    """Return the processor time of a product to the stops and one back to the modes."""
    local, back = np.empty(len(matrix)), np.empty(len(vector))
    before = process_time()
    for _ in range(PRODUCTS):
        np.dot(matrix, vector, out=local)
        np.dot(local, matrix, out=back)
    return (process_time() - before) / PRODUCTS


def main() -> int:
    """Print both times and their ratio; return 1 if it is missed."""
    parser = argparse.ArgumentParser(description="Time a step among stops with friction.")
    parser.add_argument("--modes", type=int, default=100)
    parser.add_argument("--stops", type=int, default=20)
    given = parser.parse_args()
    random = np.random.default_rng(0)
    rows = random.standard_normal((2 * given.stops, given.modes)) / np.sqrt(given.modes)
    velocity = random.standard_normal(given.modes)
    gaps = 1e-3 * random.random(given.stops)
    stops = [
        _core.FrictionStop(_core.Stop(normal, gap, 1e3, 0.0), tangent, 0.3, 0.2, 1e3, 1.0)
        for normal, tangent, gap in zip(*np.split(rows, 2), gaps, strict=True)
    ]
    march = ExplicitMarch(stops, velocity, damping=0.001, steps=STEPS)
    steps, products = [], []
    for _ in range(TURNS):
        steps.append(march.seconds_of_a_step())
        products.append(seconds_of_products(rows, velocity))
    step, product = median(steps), median(products)
    number, closed = march.contacts()
    print(f"{given.modes} modes, {given.stops} stops with friction")
    print(f"{number} contacts in {STEPS} steps, a stop closed for {100 * closed:.0f} % of them")
    print(f"both products {1e6 * product:.2f} us, one step {1e6 * step:.2f} us")
    ratio = step / product
    verdict = "PASS" if ratio <= MOST else "MISS"
    print(f"{verdict}  time of a step / time of its products = {ratio:.2f}, at most {MOST}")
    return int(ratio > MOST)


if __name__ == "__main__":
    sys.exit(main())
