"""Seeded random problems with rigid stops: rebounds, rest, several at once, beside other laws."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..problem import Array
from .coupled import random_coupled
from .forced import random_load
from .laws.law import Law
from .laws.rigid_stop import RigidStop
from .laws.stop import Stop
from .loads import Load
from .problem import SeveralStops
from .random_problems import random_several
from .rubbing import random_rubbing_stop


def random_restitution(rng: np.random.Generator) -> float:
    """Return none, all, or a part."""
    kind = rng.random()
    return 0.0 if kind < 0.25 else 1.0 if kind < 0.35 else float(rng.uniform(0.05, 0.95))


def cosine(row: Array, other: Law) -> float:
    """Return how far a row points the same way as that of a law."""
    facing = other.coordinates[0][0]
    return float(row @ facing) / float(np.linalg.norm(row) * np.linalg.norm(facing))


def wide_enough(stops: Sequence[Law], row: Array, gap: float) -> float:
    """Return a gap that leaves room between stops that face each other."""
    for other in stops:
        if cosine(row, other) < -1 + 1e-12:
            room = gap + other.coordinates[0][1]
            gap = gap if room > 0 else 1e-3 * float(np.abs(row).sum())
    return gap


def random_rigid(seed: int) -> SeveralStops:
    """Return the random problem of this seed with rigid stops, under loads in time now and then."""
    rng = np.random.default_rng([seed, 6])
    problem = random_coupled(seed) if rng.random() < 0.25 else random_several(seed)
    shared = random_restitution(rng)
    rigid: list[Law] = []
    soft: list[Law] = []
    kept: list[Stop] = []
    for stop in problem.stops:
        others = [*rigid, *soft, *kept]
        if any(cosine(stop.row, other) > 1 - 1e-12 for other in others):
            continue  # which of two alike has the impulse is nobody's business
        start = stop.gap + float(stop.row @ problem.displacement)
        gap = stop.gap - min(start, 0.0) if rng.random() < 0.8 else stop.gap - start
        gap = wide_enough(others, stop.row, gap)
        kind = rng.random()
        if kind < 0.7 or not rigid:
            rigid.append(RigidStop(stop.row, gap, shared))
        elif kind < 0.85:
            soft.append(random_rubbing_stop(rng, replace(stop, gap=gap, damping=0.0)))
        else:
            kept.append(replace(stop, gap=gap))
    loads: tuple[Load, ...] = ()
    if rng.random() < 0.3:
        omega = np.sqrt(problem.omega2)
        reference = float(np.median(omega[omega > 0])) if omega.any() else 10.0
        loads = (random_load(rng, problem, reference * 10 ** float(rng.uniform(-1, 0.5))),)
    return problem.but(stops=tuple(kept), others=(*soft, *rigid), loads=loads)
