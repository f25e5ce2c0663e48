"""Seeded random problems with springs of several slopes, beside stops or alone."""

import numpy as np

from .laws.spring import Spring
from .problem import SeveralStops
from .random_problems import LARGEST_ANGLE, random_row, random_several

MOST_SPRINGS = 4
MOST_BREAKS = 5


def random_spring(rng: np.random.Generator, modes: int, reference: float) -> Spring:
    """Return a spring that hardens, softens, has play or snaps through."""
    row = random_row(rng, modes)
    reach = float(np.abs(row).sum()) / reference
    count = int(rng.integers(1, MOST_BREAKS + 1))
    places = rng.choice([-1.0, 1.0], count) * 10 ** rng.uniform(-3, -0.3, count) * reach
    breaks = tuple(sorted(set(places.tolist())))
    slopes = reference**2 / float(row @ row) * 10 ** rng.uniform(-2, 2, len(breaks) + 1)
    slopes[rng.random(slopes.size) < 0.2] = 0.0
    inner = slopes[1:-1]
    inner[rng.random(inner.size) < 0.15] *= -0.3
    preload = float(rng.normal() * reference) if rng.random() < 0.3 else 0.0
    damping = 0.0
    if rng.random() < 0.3:
        damping = float(reference / (row @ row) * 10 ** rng.uniform(-3, 0))
    return Spring(row, breaks, tuple(slopes.tolist()), preload, damping)


def random_multilinear(seed: int) -> SeveralStops:
    """Return the random problem of this seed with springs in the place of most of its stops."""
    problem = random_several(seed)
    rng = np.random.default_rng([seed, 5])
    omega = np.sqrt(problem.omega2)
    reference = float(np.median(omega[omega > 0])) if omega.any() else 10.0
    others = tuple(
        random_spring(rng, omega.size, reference)
        for _ in range(int(rng.integers(1, MOST_SPRINGS + 1)))
    )
    stiffness = sum(max(law.stiffness) * float(law.row @ law.row) for law in others)
    return problem.but(
        stops=problem.stops[: int(rng.integers(0, 2))],
        others=others,
        duration=min(
            problem.duration, LARGEST_ANGLE / float(np.sqrt(stiffness + omega.max() ** 2))
        ),
    )
