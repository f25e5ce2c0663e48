"""The judge in double precision: scan every guard, refine every minimum, switch, and go on.

It shares nothing with the core: no eigenvalues but the fastest one's size, no modes, no bounds.

What rounding may do to a run is known from the matrices V(t, s) that carry a perturbation from
an instant s to a later one t, through every switch (saltation). Rounding enters in every phase, at
its start and on the way, so that the sum of ``V V'`` over these instants is carried beside the
state: its root is the growth, |V|.
"""

from bisect import bisect_right
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..problem import CLOSED, OPEN, RELEASED, Array
from .flow import BLOCK, PER_PERIOD, Flow, distance_row
from .guards import Guard, departure, fall, guards_of
from .problem import SeveralStops

TOUCHING = 2e-13  # of the sizes that a guard is the sum of: nothing but rounding
MOST_AT_ONCE = 64


@dataclass(frozen=True)
class Event:
    """A stop's change of state."""

    time: float
    stop: int
    before: str
    after: str


@dataclass(frozen=True)
class Minimum:
    """A guard's minimum near zero, relative to the sizes it is the sum of."""

    time: float
    stop: int
    height: float


@dataclass(frozen=True)
class Anchor:
    """Where a block of steps begins."""

    time: float
    flow: Flow
    state: Array
    growth: float


@dataclass(frozen=True)
class _Zero:
    """The first zero within a block: step, part of it, and the guard."""

    step: int
    part: float
    guard: Guard


class ScanSolution:
    """The motion of one problem up to where perturbations have grown too large, or its end."""

    def __init__(
        self,
        problem: SeveralStops,
        largest_growth: float = np.inf,
        per_period: int = PER_PERIOD,
    ) -> None:
        """Solve. ``per_period`` steps are taken over the shortest period."""
        self.per_period = per_period
        self.problem, self.exosystem = problem, problem.exosystem()
        self.largest_growth = largest_growth
        self.flows: dict[tuple[bool, ...], Flow] = {}
        self.rooms: dict[tuple[str, ...], tuple[list[Guard], Array, Array]] = {}
        self.anchors: list[Anchor] = []
        self.events: list[Event] = []
        self.minima: list[Minimum] = []
        n = problem.omega2.size
        self.sizes = np.abs(problem.displacement).max(), np.abs(problem.velocity).max()
        self.blur = np.zeros((2 * n, 2 * n))  # sum of V V', displacements before velocities
        self.growth = 1.0
        self.end = problem.duration
        self._solve()

    # -- what holds while nothing switches -------------------------------------------------

    def _flow(self, states: tuple[str, ...]) -> Flow:
        closed = tuple(state == CLOSED for state in states)
        if closed not in self.flows:
            self.flows[closed] = Flow.of(self.problem, self.exosystem, closed, self.per_period)
        return self.flows[closed]

    def _room(self, states: tuple[str, ...]) -> tuple[list[Guard], Array, Array]:
        """Return the guards, their rows (state, guard) and their series."""
        if states not in self.rooms:
            guards = [
                guard
                for number, (stop, state) in enumerate(zip(self.problem.stops, states, strict=True))
                for guard in guards_of(number, stop, state, self.exosystem)
            ]
            rows = np.array([guard.row for guard in guards])
            rows = rows.reshape(
                len(guards), 2 * self.problem.omega2.size + self.exosystem.start.size
            )
            self.rooms[states] = guards, rows.T, self._flow(states).series(rows)
        return self.rooms[states]

    def _first_states(self, z: Array) -> tuple[str, ...]:
        """Return the states told by the distances; those at zero switch at once if they must."""
        states = []
        for number, stop in enumerate(self.problem.stops):
            push = guards_of(number, stop, CLOSED, self.exosystem)[0].row @ z
            inside = distance_row(stop, self.exosystem) @ z < 0
            states.append(OPEN if not inside else CLOSED if push > 0 else RELEASED)
        return tuple(states)

    # -- the run ---------------------------------------------------------------------------

    def _solve(self) -> None:
        p = self.problem
        z = np.concatenate([p.displacement, p.velocity, self.exosystem.start])
        states, time, at_once = self._first_states(z), 0.0, 0
        resets = [*self.exosystem.resets, (np.inf, slice(0, 0), np.zeros(0))]
        begins = True
        while time < self.end:
            knot = min(resets[0][0], self.end)
            zero, span, z = self._block(states, z, time, knot - time, begins)
            time = knot if zero is None and time + span >= knot else time + span
            if self.growth > self.largest_growth:
                self.end = time
                return
            begins = zero is not None
            if zero is not None:
                before, after = states[zero.guard.stop], zero.guard.after
                if time > 0.0:  # at the start it only says what the first state is
                    self.events.append(Event(time, zero.guard.stop, before, after))
                self._saltation(zero.guard.stop, before, after)
                states = (*states[: zero.guard.stop], after, *states[zero.guard.stop + 1 :])
                at_once = at_once + 1 if span == 0.0 else 0
                if at_once > MOST_AT_ONCE:
                    raise ArithmeticError(f"endless switching at {time}")
            while resets[0][0] <= time:
                _, place, fresh = resets.pop(0)
                z[2 * p.omega2.size :][place] = fresh

    def _block(
        self, states: tuple[str, ...], z: Array, time: float, room: float, begins: bool
    ) -> tuple[_Zero | None, float, Array]:
        """Go on by one block, or to the next zero, or as far as there is room."""
        flow = self._flow(states)
        self.anchors.append(Anchor(time, flow, z, self.growth))
        steps = min(BLOCK, int(np.ceil(room / flow.step)) + 1)
        track = flow.powers[: steps + 1] @ z
        zero = self._first_zero(states, track, time, begins)
        last, part = divmod(room / flow.step, 1.0)
        step = int(last)
        if zero is not None and (zero.step + zero.part) * flow.step < room:
            step, part = zero.step, zero.part
        elif room > BLOCK * flow.step:
            zero, step, part = None, BLOCK, 0.0
        else:
            zero = None
        span = (step + part) * flow.step
        self._measure(track[: step + 1], flow, step, part)
        return zero, span, flow.within(track[step], part) if part else track[step].copy()

    def _measure(self, track: Array, flow: Flow, step: int, part: float) -> None:
        n = self.problem.omega2.size
        reach = max(self.sizes[0], float(np.abs(track[:, :n]).max()))
        speed = max(self.sizes[1], float(np.abs(track[:, n : 2 * n]).max()))
        self.sizes = reach, speed
        half = step // 2
        for steps, rest in ((half, 0.0), (step - half, part)):
            carry = flow.powers[steps]
            carry = (flow.within(carry, rest) if rest else carry)[: 2 * n, : 2 * n]
            self._carry(carry)

    def _carry(self, carry: Array) -> None:
        """Add a rounding to the perturbations and carry them on."""
        size = np.repeat([size or 1.0 for size in self.sizes], carry.shape[0] // 2)
        self.blur = carry @ (self.blur + np.diag(size**2)) @ carry.T
        relative = np.sqrt(np.trace(self.blur / size / size[:, None]))
        self.growth = max(self.growth, float(relative))

    def _saltation(self, number: int, before: str, after: str) -> None:
        """Let perturbations cross a switch: only a damper's force jumps, where it closes."""
        stop, n = self.problem.stops[number], self.problem.omega2.size
        if (before, after) == (OPEN, CLOSED) and stop.damping > 0:
            jump = np.eye(2 * n)
            jump[n:, :n] = -stop.damping * np.outer(stop.row, stop.row)
            self.blur = jump @ self.blur @ jump.T

    # -- zeros -----------------------------------------------------------------------------

    def _first_zero(
        self, states: tuple[str, ...], track: Array, time: float, begins: bool
    ) -> _Zero | None:
        guards, rows, series = self._room(states)
        values, slopes = track @ rows, track @ series[1]
        size = np.abs(track).max(axis=0) @ np.abs(rows)
        flagged = (values[1:] <= 0) | ((slopes[:-1] < 0) & (slopes[1:] > 0))
        touching = np.abs(values[0]) <= TOUCHING * size if begins else np.zeros(len(guards), bool)
        touching |= values[0] <= 0
        flagged[0] |= touching
        flagged &= size > 0  # one that is nothing but zeros is at rest
        best: _Zero | None = None
        for step, which in np.argwhere(flagged).tolist():
            if best is not None and step > best.step:
                break
            coefficients = (track[step] @ series[:, :, which].T).tolist()
            if step == 0 and touching[which]:
                found = departure(coefficients, TOUCHING * float(size[which]))
            else:
                found = fall(coefficients)
            if found.lowest is not None:
                at = time + step * self._flow(states).step
                height = abs(found.lowest) / float(size[which])
                self.minima.append(Minimum(at, guards[which].stop, height))
            if found.at is not None and (best is None or found.at < best.part):
                best = _Zero(step, found.at, guards[which])
        return best

    # -- what came out ---------------------------------------------------------------------

    def motion(self, times: Array) -> tuple[Array, Array]:
        """Return displacement and velocity, each (time, mode)."""
        n, starts = self.problem.omega2.size, [anchor.time for anchor in self.anchors]
        states = []
        for time in times.tolist():
            anchor = self.anchors[max(bisect_right(starts, time) - 1, 0)]
            step, part = divmod((time - anchor.time) / anchor.flow.step, 1.0)
            step, part = (int(step), part) if step <= BLOCK else (BLOCK, step + part - BLOCK)
            states.append(anchor.flow.within(anchor.flow.powers[step] @ anchor.state, part))
        return np.array(states)[:, :n], np.array(states)[:, n : 2 * n]

    def growth_at(self, times: Array) -> Array:
        """Return how much a perturbation of the start may have grown, |V| or one."""
        starts = [anchor.time for anchor in self.anchors]
        growths = [following.growth for _, following in pairwise(self.anchors)] + [self.growth]
        return np.array([growths[max(bisect_right(starts, t) - 1, 0)] for t in times.tolist()])
