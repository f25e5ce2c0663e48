"""Seeded random problems with friction on stops: stick, slip, both dampers, and flutter."""

import numpy as np

from .laws.friction_stop import FrictionStop
from .laws.stop import Stop
from .problem import SeveralStops
from .random_problems import LARGEST_ANGLE, random_row, random_several


def random_rubbing_stop(rng: np.random.Generator, stop: Stop) -> FrictionStop:
    """Return a stop with friction, slight or more than enough to stick, damped or not."""
    tangent = random_row(rng, stop.row.size)
    stiffness = stop.stiffness * float(stop.row @ stop.row) / float(tangent @ tangent)
    stiffness *= 10 ** float(rng.uniform(-1.5, 1))
    static = 10 ** float(rng.uniform(-2, 0.3))
    dynamic = static * (1.0 if rng.random() < 0.5 else float(rng.uniform(0.3, 1.0)))
    damping = 0.0
    if rng.random() < 0.3:
        pace = float(np.sqrt(stiffness * float(tangent @ tangent)))
        damping = stiffness / pace * 10 ** float(rng.uniform(-3, 0.3))
    return FrictionStop(stop, tangent, static, dynamic, stiffness, damping)


def random_rubbing(seed: int) -> SeveralStops:
    """Return the random problem of this seed, most of its stops with friction."""
    problem = random_several(seed)
    rng = np.random.default_rng([seed, 4])
    rubs = rng.random(len(problem.stops)) < 0.8
    rubs[0] = True
    pairs = list(zip(problem.stops, rubs, strict=True))
    others = tuple(random_rubbing_stop(rng, stop) for stop, rub in pairs if rub)
    stiffness = sum(law.stiffness * float(law.tangent @ law.tangent) for law in others)
    rate = float(np.sqrt(stiffness + problem.omega2.max()))
    return problem.but(
        stops=tuple(stop for stop, rub in pairs if not rub),
        others=others,
        duration=min(problem.duration, LARGEST_ANGLE / rate),
    )
