"""Forces in time that a linear system of their own makes: what a matrix exponential can carry.

Each load is ``shape * f(t)`` with ``f = first entry of w``, ``w' = generator w``: a harmonic turns,
a polynomial is the chain of its derivatives, a table has a value and a slope which is set anew
at every knot.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import factorial

import numpy as np
from scipy.linalg import block_diag

from ..problem import Array


@dataclass(frozen=True)
class Harmonic:
    """``shape * cos(frequency t + phase)``, with the frequency in rad/s."""

    shape: Array
    frequency: float
    phase: float = 0.0

    @property
    def generator(self) -> Array:
        """Return the matrix of (cos, sin)."""
        return self.frequency * np.array([[0.0, -1.0], [1.0, 0.0]])

    def start(self) -> Array:
        """Return the state at t = 0."""
        return np.array([np.cos(self.phase), np.sin(self.phase)])

    def knots(self) -> list[tuple[float, Array]]:
        """Return where the state is set anew, and to what: nowhere."""
        return []


@dataclass(frozen=True)
class Polynomial:
    """``shape * sum of coefficients[n] t^n``."""

    shape: Array
    coefficients: tuple[float, ...]

    @property
    def generator(self) -> Array:
        """Return the matrix of the chain of derivatives."""
        return np.eye(len(self.coefficients), k=1)

    def start(self) -> Array:
        """Return the derivatives at t = 0."""
        return np.array([factorial(n) * a for n, a in enumerate(self.coefficients)], dtype=float)

    def knots(self) -> list[tuple[float, Array]]:
        """Return where the state is set anew, and to what: nowhere."""
        return []


@dataclass(frozen=True)
class Table:
    """``shape * f(t)``, f linear between the points given; they cover the run from t = 0."""

    shape: Array
    times: Array
    values: Array

    @property
    def generator(self) -> Array:
        """Return the matrix of value and slope."""
        return np.array([[0.0, 1.0], [0.0, 0.0]])

    def start(self) -> Array:
        """Return value and slope at t = 0."""
        return self.knots()[0][1]

    def knots(self) -> list[tuple[float, Array]]:
        """Return each point with the value there and the slope that follows."""
        slopes = np.append(np.diff(self.values) / np.diff(self.times), 0.0)
        states = np.stack([self.values, slopes], axis=1)
        return list(zip(self.times.tolist(), states, strict=True))


Load = Harmonic | Polynomial | Table


@dataclass(frozen=True)
class Exosystem:
    """All loads of a problem as one linear system; its state's first entry is the number one."""

    generator: Array
    gain: Array  # (modes, states): the modal force is gain @ state
    start: Array
    resets: list[tuple[float, slice, Array]]  # time, where in the state, and what follows

    @classmethod
    def of(cls, force: Array, loads: Sequence[Load]) -> "Exosystem":
        """Join a constant modal force and loads."""
        blocks, starts, columns = [np.zeros((1, 1))], [np.ones(1)], [force[:, None]]
        resets: list[tuple[float, slice, Array]] = []
        size = 1
        for load in loads:
            start = load.start()
            blocks.append(load.generator)
            starts.append(start)
            columns.append(np.outer(load.shape, np.eye(start.size)[0]))
            place = slice(size, size + start.size)
            resets += [(time, place, state) for time, state in load.knots() if time > 0]
            size += start.size
        return cls(
            generator=block_diag(*blocks),
            gain=np.hstack(columns),
            start=np.concatenate(starts),
            resets=sorted(resets, key=lambda reset: reset[0]),
        )
