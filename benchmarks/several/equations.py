"""The equations of motion as a Python user writes them for a general ODE solver."""

from dataclasses import dataclass

import numpy as np

from tests.reference.problem import Array
from tests.reference.several.problem import SeveralStops


@dataclass(frozen=True)
class Equations:
    """``y = (q, q')`` with undamped stops as one branch-free expression."""

    omega2: Array
    damping: Array
    rows: Array
    gaps: Array
    stiffness: Array

    @classmethod
    def of(cls, problem: SeveralStops) -> "Equations":
        """Take a problem apart."""
        return cls(
            omega2=problem.omega2,
            damping=problem.damping,
            rows=np.array([stop.row for stop in problem.stops]),
            gaps=np.array([stop.gap for stop in problem.stops]),
            stiffness=np.array([stop.stiffness for stop in problem.stops]),
        )

    @property
    def modes(self) -> int:
        """Return how many there are."""
        return self.omega2.size

    def distances(self, state: Array) -> Array:
        """Return the distance of each stop."""
        distances: Array = self.gaps + self.rows @ state[: self.modes]
        return distances

    def rates(self, state: Array) -> Array:
        """Return y'."""
        displacement, velocity = state[: self.modes], state[self.modes :]
        push = -self.stiffness * np.minimum(self.distances(state), 0.0)
        acceleration = push @ self.rows - self.omega2 * displacement - self.damping * velocity
        return np.concatenate([velocity, acceleration])

    def jacobian(self, state: Array) -> Array:
        """Return the derivative of y' by y."""
        n, closed = self.modes, self.distances(state) < 0
        matrix = np.zeros((2 * n, 2 * n))
        matrix[:n, n:] = np.eye(n)
        matrix[n:, :n] = -(self.rows[closed].T * self.stiffness[closed]) @ self.rows[closed]
        matrix[n:, :n] -= np.diag(self.omega2)
        matrix[n:, n:] = -np.diag(self.damping)
        return matrix
