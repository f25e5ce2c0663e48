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
    """``shape * f(t)``, f linear between the points given; two points at one time are a jump."""

    shape: Array
    times: Array
    values: Array
    holds: bool = True  # beyond the points the nearest value; else zero

    @property
    def generator(self) -> Array:
        """Return the matrix of value and slope."""
        return np.array([[0.0, 1.0], [0.0, 0.0]])

    def start(self) -> Array:
        """Return value and slope at t = 0."""
        begun = [state for time, state in self.knots() if time <= 0.0]
        before = np.array([self.values[0] if self.holds else 0.0, 0.0])
        # A point before t = 0 is told on to t = 0.
        past = max((t for t in self.times.tolist() if t <= 0.0), default=0.0)
        state = begun[-1] if begun else before
        return np.array([state[0] - past * state[1], state[1]])

    def knots(self) -> list[tuple[float, Array]]:
        """Return each point with the value there and the slope that follows."""
        spans = np.diff(self.times)
        slopes = np.diff(self.values) / np.where(spans > 0, spans, np.inf)
        states = np.stack([self.values, np.append(slopes, 0.0)], axis=1)
        if not self.holds:
            states[-1] = 0.0
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
