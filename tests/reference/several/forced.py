"""Seeded random problems under forces in time: harmonic, polynomial, tables, and resonance."""

import numpy as np

from ..problem import Array
from .loads import Harmonic, Load, Polynomial, Table
from .problem import SeveralStops
from .random_problems import random_several

MOST_LOADS = 3
HIGHEST_DEGREE = 5
MOST_KNOTS = 40


def random_harmonic(rng: np.random.Generator, shape: Array, omega: Array) -> Harmonic:
    """Return a harmonic load, now and then on a natural frequency."""
    frequency = float(rng.uniform(0.1, 1.5) * max(omega.max(), 1.0))
    if rng.random() < 0.2 and omega.any():
        frequency = float(rng.choice(omega[omega > 0]))  # resonance
    return Harmonic(shape, frequency, float(rng.uniform(0, 2 * np.pi)))


def random_polynomial(rng: np.random.Generator, shape: Array, duration: float) -> Polynomial:
    """Return a polynomial whose terms are about one at the end of the run."""
    degree = int(rng.integers(0, HIGHEST_DEGREE + 1))
    coefficients = rng.normal(size=degree + 1) / duration ** np.arange(degree + 1)
    return Polynomial(shape, tuple(coefficients.tolist()))


def random_table(rng: np.random.Generator, shape: Array, duration: float) -> Table:
    """Return straight lines between points, evenly spaced or not, with jumps or without."""
    count = int(rng.integers(2, MOST_KNOTS))
    steps = np.ones(count) if rng.random() < 0.5 else rng.uniform(0.05, 1.0, count)
    if rng.random() < 0.2:
        steps[rng.integers(1, count)] = 0.0
    times = np.concatenate([[0.0], np.cumsum(steps)]) * (1.001 * duration / steps.sum())
    if rng.random() < 0.2:  # it begins later and ends earlier than the run
        times = 0.1 * duration + 0.7 * times
    return Table(shape, times, rng.normal(size=count + 1), bool(rng.random() < 0.5))


def random_load(rng: np.random.Generator, problem: SeveralStops, size: float) -> Load:
    """Return one load on all modes or on one."""
    modes = problem.omega2.size
    shape = rng.normal(size=modes) * size
    if rng.random() < 0.3:
        shape = shape * (np.arange(modes) == rng.integers(modes))
    kind = rng.integers(3)
    if kind == 0:
        return random_harmonic(rng, shape, np.sqrt(problem.omega2))
    if kind == 1:
        return random_polynomial(rng, shape, problem.duration)
    return random_table(rng, shape, problem.duration)


def random_forced(seed: int) -> SeveralStops:
    """Return the random problem of this seed with one to three loads that change in time."""
    problem = random_several(seed)
    rng = np.random.default_rng([seed, 1])
    omega = np.sqrt(problem.omega2)
    reference = float(np.median(omega[omega > 0])) if omega.any() else 10.0
    loads = tuple(
        random_load(rng, problem, reference * 10 ** float(rng.uniform(-1, 0.5)))
        for _ in range(int(rng.integers(1, MOST_LOADS + 1)))
    )
    return problem.but(loads=loads)
