"""The linear flow while one set of stops is closed, by matrix exponentials.

A scan step is a hundredth of the shortest period: so short that within it the Taylor series of
the exponential is exact to rounding after a few terms, which makes every guard a polynomial there.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import expm

from ..problem import Array
from .loads import Exosystem
from .problem import SeveralStops, Stop

PER_PERIOD = 100
BLOCK = 64
TERMS = 15


def distance_row(stop: Stop, exosystem: Exosystem) -> Array:
    """Return the distance as a row over (displacement, velocity, exosystem)."""
    none = np.zeros(exosystem.start.size - 1)
    return np.concatenate([stop.row, np.zeros_like(stop.row), [stop.gap], none])


def rate_row(stop: Stop, exosystem: Exosystem) -> Array:
    """Return the distance's rate as such a row."""
    return np.concatenate([np.zeros_like(stop.row), stop.row, np.zeros(exosystem.start.size)])


@dataclass(frozen=True)
class Flow:
    """``z' = matrix z`` over (displacement, velocity, exosystem), for some closed stops."""

    matrix: Array
    scale: Array  # powers of two that balance displacement and velocity
    step: float

    @classmethod
    def of(
        cls,
        problem: SeveralStops,
        exosystem: Exosystem,
        closed: tuple[bool, ...],
        per_period: int = PER_PERIOD,
    ) -> "Flow":
        """Make the flow of a problem while the stops marked are closed."""
        n, m = problem.omega2.size, exosystem.start.size
        matrix = np.zeros((2 * n + m, 2 * n + m))
        matrix[:n, n : 2 * n] = np.eye(n)
        matrix[n : 2 * n, :n] = -np.diag(problem.omega2)
        matrix[n : 2 * n, n : 2 * n] = -np.diag(problem.damping)
        if problem.coupling is not None:
            matrix[n : 2 * n, n : 2 * n] -= problem.coupling
        matrix[n : 2 * n, 2 * n :] = exosystem.gain
        matrix[2 * n :, 2 * n :] = exosystem.generator
        for stop, pushes in zip(problem.stops, closed, strict=True):
            if pushes:
                push = -stop.stiffness * distance_row(stop, exosystem)
                push -= stop.damping * rate_row(stop, exosystem)
                matrix[n : 2 * n] += np.outer(stop.row, push)
        fastest = float(np.abs(np.linalg.eigvals(matrix)).max())
        # Defective zeros come out as small numbers: the run's length is what they must not exceed.
        fastest = max(fastest, 1.0 / problem.duration)
        scale = np.ones(len(matrix))
        scale[n : 2 * n] = 2.0 ** np.round(np.log2(fastest))
        return cls(matrix, scale, 2 * np.pi / (per_period * fastest))

    @cached_property
    def balanced(self) -> Array:
        """Return the matrix times the step, with velocities measured by the fastest rate."""
        balanced: Array = self.matrix * self.step * self.scale / self.scale[:, None]
        return balanced

    @cached_property
    def powers(self) -> Array:
        """Return the propagators over 0, 1, ..., BLOCK steps."""
        powers = [np.eye(len(self.matrix)), expm(self.balanced)]
        while len(powers) <= BLOCK:  # by doubling, so that rounding does not pile up
            n = len(powers)
            powers.append(powers[n // 2] @ powers[n - n // 2])
        scaled: Array = np.array(powers) * self.scale[:, None] / self.scale
        return scaled

    def within(self, z: Array, part: float) -> Array:
        """Return states (or columns of them) a part of one step later."""
        matrix = self.matrix * self.step
        term = total = z
        for n in range(1, TERMS):
            term = matrix @ term * (part / n)
            total = total + term
        return total

    def series(self, rows: Array) -> Array:
        """Return what makes Taylor coefficients of guards over a step, (term, state, guard)."""
        matrix = self.matrix * self.step
        terms = [rows]
        for n in range(1, TERMS):
            terms.append(terms[-1] @ matrix / n)
        return np.array(terms).transpose(0, 2, 1)
