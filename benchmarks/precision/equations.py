"""The equations of motion as a Python user writes them for a general ODE solver."""

from __future__ import annotations

import numpy as np

from benchmarks.precision.problems import Watched
from tests.reference.problem import Array


class Equations:
    """``y = (q, q')`` of modes under stops with dampers."""

    def __init__(self, problem: Watched) -> None:
        basis, stops = problem.problem.basis, problem.stops
        self.omega2, self.damping = basis.omega2, basis.damping
        self.rows = np.array([stop.coordinate.row(basis) for stop in stops])
        self.gaps = np.array([stop.gap for stop in stops])
        self.stiffness = np.array([stop.stiffness for stop in stops])
        self.dashpots = np.array([stop.damping for stop in stops])
        self.start = np.concatenate(problem.start)
        self.modes = len(basis.omega2)

    def push(self, displacement: Array, velocity: Array) -> Array:
        """Return the modal forces of the stops, (N,)."""
        distance = self.gaps + self.rows @ displacement
        force = -self.stiffness * distance - self.dashpots * (self.rows @ velocity)
        pushes: Array = np.where(distance < 0.0, np.maximum(force, 0.0), 0.0) @ self.rows
        return pushes

    def rates(self, _time: float, state: Array) -> Array:
        """Return y'."""
        q, v = state[: self.modes], state[self.modes :]
        acceleration = self.push(q, v) - self.omega2 * q - self.damping * v
        return np.concatenate([v, acceleration])
