"""The linear flow while the laws keep their states, by matrix exponentials.

A scan step is a hundredth of the shortest period: so short that within it the Taylor series of
the exponential is exact to rounding after a few terms, which makes every guard a polynomial there.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import expm

from ..problem import Array
from .laws.form import Form
from .laws.law import Law
from .loads import Exosystem
from .problem import SeveralStops

PER_PERIOD = 100
BLOCK = 64
TERMS = 15


@dataclass(frozen=True)
class Layout:
    """Where in a state ``z`` things stand: displacement, velocity, memories, exosystem."""

    problem: SeveralStops
    exosystem: Exosystem

    @cached_property
    def laws(self) -> tuple[Law, ...]:
        """The laws; each has one memory, used or not."""
        return self.problem.laws

    @property
    def modes(self) -> int:
        """Number of modes."""
        return self.problem.omega2.size

    @property
    def inner(self) -> int:
        """Size of what perturbations move: all but the exosystem, which is given."""
        return 2 * self.modes + len(self.laws)

    @property
    def size(self) -> int:
        """Size of a state."""
        return self.inner + self.exosystem.start.size

    def start(self) -> Array:
        """Return the state at t = 0, with nothing remembered."""
        p = self.problem
        memories = np.zeros(len(self.laws))
        return np.concatenate([p.displacement, p.velocity, memories, self.exosystem.start])

    def coordinate(self, law: int, number: int) -> Array:
        """Return a law's local coordinate as a row over the state."""
        row, offset = self.laws[law].coordinates[number]
        whole = np.zeros(self.size)
        whole[: self.modes], whole[self.inner] = row, offset
        return whole

    def row(self, law: int, form: Form[float], matrix: Array | None = None) -> Array:
        """Return a function of a law's local motion; accelerations are those of ``z' = matrix z``.

        Without a matrix only positions and velocities can be asked for.
        """
        whole = np.zeros(self.size)
        whole[self.inner] = form.constant
        whole[2 * self.modes + law] = form.memory
        for (number, order), factor in form.factors.items():
            derivative = self.coordinate(law, number)
            if order > 0:
                derivative = np.roll(
                    np.where(np.arange(self.size) < self.modes, derivative, 0.0), self.modes
                )
            for _ in range(order - 1):
                assert matrix is not None
                derivative = derivative @ matrix
            whole = whole + factor * derivative
        return whole


@dataclass(frozen=True)
class Flow:
    """``z' = matrix z`` while the laws keep their states."""

    matrix: Array
    scale: Array  # powers of two that balance displacement and velocity
    step: float
    reactions: dict[int, Array]  # of the laws that hold their coordinate, as rows over the state

    @classmethod
    def of(cls, layout: Layout, states: tuple[str, ...], per_period: int = PER_PERIOD) -> "Flow":
        """Make the flow of a problem in given states of its laws."""
        problem, n = layout.problem, layout.modes
        matrix = np.zeros((layout.size, layout.size))
        matrix[:n, n : 2 * n] = np.eye(n)
        matrix[n : 2 * n, :n] = -np.diag(problem.omega2)
        matrix[n : 2 * n, n : 2 * n] = -np.diag(problem.damping)
        if problem.coupling is not None:
            matrix[n : 2 * n, n : 2 * n] -= problem.coupling
        matrix[n : 2 * n, layout.inner :] = layout.exosystem.gain
        matrix[layout.inner :, layout.inner :] = layout.exosystem.generator
        for number, (law, state) in enumerate(zip(layout.laws, states, strict=True)):
            for (row, _), force in zip(law.coordinates, law.forces(state, 1.0), strict=False):
                matrix[n : 2 * n] += np.outer(row, layout.row(number, force))
        reactions = _hold(layout, states, matrix)
        fastest = float(np.abs(np.linalg.eigvals(matrix)).max())
        # Defective zeros come out as small numbers: the run's length is what they must not exceed.
        fastest = max(fastest, 1.0 / problem.duration)
        scale = np.ones(len(matrix))
        scale[n : 2 * n] = 2.0 ** np.round(np.log2(fastest))
        return cls(matrix, scale, 2 * np.pi / (per_period * fastest), reactions)

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


def _hold(layout: Layout, states: tuple[str, ...], matrix: Array) -> dict[int, Array]:
    """Add the reactions that keep held coordinates where they are; return them as rows."""
    both = enumerate(zip(layout.laws, states, strict=True))
    held = [number for number, (law, state) in both if law.holds(state)]
    if not held:
        return {}
    n = layout.modes
    rows = np.array([layout.laws[number].coordinates[0][0] for number in held])
    accelerations = matrix[n : 2 * n]
    reactions = -np.linalg.pinv(rows @ rows.T, rcond=1e-12) @ rows @ accelerations
    accelerations += rows.T @ reactions
    return dict(zip(held, reactions, strict=True))
