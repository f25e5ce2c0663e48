"""Seeded random problems whose modes are coupled by dampers of the structure and by its spin."""

import numpy as np

from .problem import SeveralStops
from .random_problems import random_several

MOST_DAMPERS = 3


def random_coupled(seed: int) -> SeveralStops:
    """Return the random problem of this seed with dampers between points, with spin, or both."""
    problem = random_several(seed)
    rng = np.random.default_rng([seed, 2])
    modes = problem.omega2.size
    rate = float(np.sqrt(problem.omega2.max())) or 10.0
    coupling = np.zeros((modes, modes))
    kind = rng.integers(3)
    if kind != 1:
        for row in rng.normal(size=(int(rng.integers(1, MOST_DAMPERS + 1)), modes)):
            coupling += rate / modes * 10 ** rng.uniform(-3, 0) * np.outer(row, row)
    if kind != 0:
        skew = rng.normal(size=(modes, modes))
        coupling += rate / modes * 10 ** rng.uniform(-2, 0) * (skew - skew.T)
    return problem.but(coupling=coupling)
