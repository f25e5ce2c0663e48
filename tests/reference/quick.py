"""Double-precision oracle: matrix exponentials of the augmented state, guards scanned in blocks.

It knows nothing of the fifty-digit one but the states' names, so that the two check each other.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

from .problem import CLOSED, OPEN, RELEASED, Array, StopProblem

PER_PERIOD = 100
BLOCK = 64


@dataclass(frozen=True)
class Phase:
    """A stretch of one state, from an augmented state (displacement, velocity, 1)."""

    state: str
    start: float
    initial: Array


class QuickSolution:
    """The motion of one problem and its switches."""

    def __init__(self, problem: StopProblem) -> None:
        """Solve."""
        self.problem = problem
        self.matrices = {state: self._matrix(state) for state in (OPEN, CLOSED)}
        self.matrices[RELEASED] = self.matrices[OPEN]
        self.tables = {state: self._table(state) for state in self.matrices}
        self.phases: list[Phase] = []
        self.events: list[tuple[float, str, str]] = []
        self._solve()

    def _matrix(self, state: str) -> Array:
        p, n = self.problem, self.problem.omega2.size
        k, c = (p.stiffness, p.stop_damping) if state == CLOSED else (0.0, 0.0)
        matrix = np.zeros((2 * n + 1, 2 * n + 1))
        matrix[:n, n : 2 * n] = np.eye(n)
        matrix[n : 2 * n, :n] = -np.diag(p.omega2) - k * np.outer(p.row, p.row)
        matrix[n : 2 * n, n : 2 * n] = -np.diag(p.damping) - c * np.outer(p.row, p.row)
        matrix[n : 2 * n, -1] = p.force - k * p.gap * p.row
        return matrix

    def _table(self, state: str) -> tuple[float, Array]:
        """Return the scan step and the propagators over 0, 1, ..., BLOCK of them."""
        matrix = self.matrices[state]
        fastest = np.abs(np.linalg.eigvals(matrix)).max()
        step = 2 * np.pi / (PER_PERIOD * fastest) if fastest > 0 else self.problem.duration / 1e3
        one = expm(matrix * step)
        powers = [np.eye(len(matrix))]
        for _ in range(BLOCK):
            powers.append(one @ powers[-1])
        return step, np.array(powers)

    def _rows(self, state: str) -> dict[str, Array]:
        """Return guards as rows over the augmented state, by the state that follows."""
        p, none = self.problem, np.zeros_like(self.problem.row)
        distance = np.concatenate([p.row, none, [p.gap]])
        rate = np.concatenate([none, p.row, [0.0]])
        trial = -p.stiffness * distance - p.stop_damping * rate
        if state == OPEN:
            return {CLOSED: distance}
        if state == CLOSED:
            return {RELEASED if p.stop_damping > 0 else OPEN: trial}
        return {OPEN: -distance, CLOSED: -trial}

    def _first_state(self, x: Array) -> str:
        distance, flow = self._rows(OPEN)[CLOSED], self.matrices[OPEN]
        derivatives = [distance @ np.linalg.matrix_power(flow, n) @ x for n in range(4)]
        leading = next((d for d in derivatives if d != 0.0), 1.0)
        if derivatives[0] > 0 or (derivatives[0] == 0 and leading > 0):
            return OPEN
        trial = next(iter(self._rows(CLOSED).values())) @ x
        return CLOSED if derivatives[0] == 0 or trial > 0 else RELEASED

    def _solve(self) -> None:
        p = self.problem
        x = np.concatenate([p.displacement, p.velocity, [1.0]])
        state, time = self._first_state(x), 0.0
        while True:
            self.phases.append(Phase(state, time, x))
            found = self._next_event(state, x, p.duration - time)
            if found is None:
                return
            span, after, x = found
            time += span
            self.events.append((time, state, after))
            state = after

    def _next_event(
        self, state: str, x: Array, remaining: float
    ) -> tuple[float, str, Array] | None:
        step, powers = self.tables[state]
        base = 0.0
        while base < remaining:
            states = powers @ x
            hits = [
                (span, after)
                for after, row in self._rows(state).items()
                if (span := self._crossing(state, row, states, first=base == 0.0)) is not None
            ]
            if hits:
                span, after = min(hits)
                if base + span >= remaining:
                    return None
                index = min(int(span / step), BLOCK)
                return (
                    base + span,
                    after,
                    expm(self.matrices[state] * (span - index * step)) @ states[index],
                )
            x, base = states[-1], base + BLOCK * step
        return None

    def _crossing(self, state: str, row: Array, states: Array, first: bool) -> float | None:
        """Return when a guard first falls below zero among the samples of one block."""
        step, matrix = self.tables[state][0], self.matrices[state]
        values, slopes = states @ row, states @ (row @ matrix)
        begin = 1 if first and not values[0] > 1e-9 * np.abs(values).max() else 0

        def value(span: float, cell: int) -> float:
            return float(row @ expm(matrix * span) @ states[cell])

        def slope(span: float, cell: int) -> float:
            return float(row @ matrix @ expm(matrix * span) @ states[cell])

        if begin == 1 and values[1] <= 0:  # a phase shorter than one cell
            left = next(span for n in range(1, 30) if value(span := step * 0.5**n, 0) > 0)
            return float(brentq(value, left, 2 * left, args=(0,), xtol=1e-17, rtol=1e-14))
        minimum = (slopes[:-1] < 0) & (slopes[1:] > 0)
        for cell in (begin + np.flatnonzero((minimum | (values[1:] <= 0))[begin:])).tolist():
            right = step
            if minimum[cell]:
                right = brentq(slope, 0.0, step, args=(cell,), xtol=1e-17, rtol=1e-14)
            if value(right, cell) <= 0:
                span = brentq(value, 0.0, right, args=(cell,), xtol=1e-17, rtol=1e-14)
                return float(cell * step + span)
            if values[cell + 1] <= 0:
                span = brentq(value, right, step, args=(cell,), xtol=1e-17, rtol=1e-14)
                return float(cell * step + span)
        return None

    def motion(self, times: Array) -> tuple[Array, Array]:
        """Return displacement and velocity, each (time, mode)."""
        n, starts = self.problem.omega2.size, [phase.start for phase in self.phases]
        states = []
        for time in times:
            phase = self.phases[max(int(np.searchsorted(starts, time, side="right")) - 1, 0)]
            states.append(expm(self.matrices[phase.state] * (time - phase.start)) @ phase.initial)
        return np.array(states)[:, :n], np.array(states)[:, n : 2 * n]
