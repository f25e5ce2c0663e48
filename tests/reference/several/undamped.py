"""Problems that lose nothing: random ones without dampers, their energy, and their way back."""

from dataclasses import replace

import numpy as np

from ..problem import Array
from .problem import SeveralStops
from .random_problems import random_several


def random_undamped(seed: int, longer: float) -> SeveralStops:
    """Return a random problem without dampers that runs so many times longer."""
    problem = random_several(seed)
    return problem.but(
        damping=np.zeros_like(problem.damping),
        stops=tuple(replace(stop, damping=0.0) for stop in problem.stops),
        duration=longer * problem.duration,
    )


def energies(problem: SeveralStops, displacement: Array, velocity: Array) -> Array:
    """Return kinetic, elastic, stops' and the constant force's energy, (term, time)."""
    depths = [np.minimum(s.gap + displacement @ s.row, 0.0) for s in problem.stops]
    springs = sum(s.stiffness * d**2 / 2 for s, d in zip(problem.stops, depths, strict=True))
    return np.stack(
        [
            (velocity**2).sum(axis=1) / 2,
            displacement**2 @ problem.omega2 / 2,
            np.broadcast_to(springs, velocity.shape[:1]),
            -displacement @ problem.force,
        ]
    )


def energy_drift(problem: SeveralStops, displacement: Array, velocity: Array) -> float:
    """Return the largest change of the energy, relative to the largest part of it."""
    terms = energies(problem, displacement, velocity)
    total = terms.sum(axis=0)
    start = energies(problem, problem.displacement[None], problem.velocity[None])
    return float(np.abs(total - start.sum()).max() / max(np.abs(terms).max(), np.abs(start).max()))


def reversed_from(problem: SeveralStops, displacement: Array, velocity: Array) -> SeveralStops:
    """Return the problem that starts where a run has ended, the other way."""
    return problem.but(displacement=displacement, velocity=-velocity)
