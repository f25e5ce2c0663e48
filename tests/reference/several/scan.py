"""The judge in double precision: scan every guard, refine every minimum, switch, and go on.

It shares nothing with the core: no eigenvalues but the fastest one's size, no modes, no bounds.
How far rounding may carry a run is told by its perturbations.
"""

from bisect import bisect_right
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..problem import Array
from .flow import BLOCK, PER_PERIOD, Flow, Layout
from .guards import Guard, departure, fall, guards_of
from .impacts import Contacts, Tail
from .laws.form import Form
from .perturbations import TOUCHING, Perturbations
from .problem import SeveralStops

MOST_AT_ONCE = 64


@dataclass(frozen=True)
class Event:
    """A law's change of state, or an impact."""

    time: float
    stop: int
    before: str
    after: str

    @property
    def states(self) -> tuple[str, str]:
        """Before and after."""
        return self.before, self.after


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
        self.layout = Layout(problem, self.exosystem)
        self.flows: dict[tuple[str, ...], Flow] = {}
        self.rooms: dict[tuple[str, ...], tuple[list[Guard], Array, Array]] = {}
        self.perturbations = Perturbations(self.layout)
        self.contacts = Contacts(self.perturbations, self._flow)
        self.anchors: list[Anchor] = []
        self.events: list[Event] = []
        self.minima: list[Minimum] = []
        self.end = problem.duration
        self._solve()

    @property
    def growth(self) -> float:
        """How much a perturbation may have grown."""
        return self.perturbations.growth

    @property
    def tails(self) -> list[Tail]:
        """Stretches in which rebounds come to their end."""
        return self.contacts.tails

    @property
    def sizes(self) -> tuple[float, float]:
        """The largest displacement and velocity."""
        return self.perturbations.sizes

    # -- what holds while nothing switches -------------------------------------------------

    def _flow(self, states: tuple[str, ...]) -> Flow:
        if states not in self.flows:
            self.flows[states] = Flow.of(self.layout, states, self.per_period)
        return self.flows[states]

    def _room(self, states: tuple[str, ...]) -> tuple[list[Guard], Array, Array]:
        """Return the guards, their rows (state, guard) and their series."""
        if states not in self.rooms:
            guards = guards_of(self.layout, states, self._flow(states))
            rows = np.array([guard.row for guard in guards])
            rows = rows.reshape(len(guards), self.layout.size)
            self.rooms[states] = guards, rows.T, self._flow(states).series(rows)
        return self.rooms[states]

    def _start(self) -> tuple[tuple[str, ...], Array]:
        """Return the states told by the motion; those at zero switch at once if they must."""
        z, states = self.layout.start(), []
        for number, law in enumerate(self.layout.laws):

            def value(form: Form[float], number: int = number) -> float:
                return float(self.layout.row(number, form) @ z)

            state = law.start(value, 1.0)
            remembered = law.memory("", state, state, 1.0)
            if remembered is not None:
                z[2 * self.layout.modes + number] = value(remembered)
            states.append(state)
        return tuple(states), z

    # -- the run ---------------------------------------------------------------------------

    def _solve(self) -> None:
        states, z = self._start()
        time, at_once = 0.0, 0
        resets = [*self.exosystem.resets, (np.inf, slice(0, 0), np.zeros(0))]
        states, z = self._meet(states, z, time, None)
        begins = True
        while time < self.end:
            knot = min(resets[0][0], self.end)
            zero, span, z = self._block(states, z, time, knot - time, begins)
            time = knot if zero is None and time + span >= knot else time + span
            if self.growth > self.largest_growth:
                self._end(time, zero)
                return
            begins = zero is not None
            if zero is not None:
                states, z = self._switch(states, z, time, zero.guard)
                if self.contacts.tangled:
                    self._end(time, zero)
                    return
                at_once = at_once + 1 if span == 0.0 else 0
                if at_once > MOST_AT_ONCE:
                    raise ArithmeticError(f"endless switching at {time}")
            while resets[0][0] <= time:
                _, place, fresh = resets.pop(0)
                z[self.layout.inner :][place] = fresh
                begins = True

    def _end(self, time: float, zero: _Zero | None) -> None:
        """End before the run does; what happens at this instant is not judged any more."""
        self.end = time
        if zero is not None:
            self.contacts.tails.append(Tail(zero.guard.law, time, time))

    def _switch(
        self, states: tuple[str, ...], z: Array, time: float, guard: Guard
    ) -> tuple[tuple[str, ...], Array]:
        """Let a law go over to its next state."""
        law, before = self.layout.laws[guard.law], states[guard.law]
        if law.restitution is not None:
            return self._meet(states, z, time, guard)

        def going_on(state: str) -> tuple[str, ...]:
            return (*states[: guard.law], state, *states[guard.law + 1 :])

        def sign(state: str, form: Form[float]) -> int:
            row = self.layout.row(guard.law, form, self._flow(going_on(state)).matrix)
            value, zero = self.perturbations.value(row, z)
            return 0 if abs(value) <= zero else 1 if value > 0 else -1

        after = law.follow(before, guard.tried, sign, 1.0)
        jump = np.eye(self.layout.size)
        remembered = law.memory(before, guard.tried, after, 1.0)
        if remembered is not None:
            jump[2 * self.layout.modes + guard.law] = self.layout.row(guard.law, remembered)
        self._note(Event(time, guard.law, before, after))
        return going_on(after), self._cross(jump, states, going_on(after), guard.row, z)

    def _meet(
        self, states: tuple[str, ...], z: Array, time: float, cause: Guard | None
    ) -> tuple[tuple[str, ...], Array]:
        """Let rigid stops in touch do their work."""
        meeting = self.contacts.meet(states, z, time, cause)
        if meeting is None:
            return states, z
        for law, before, after in meeting.switches:
            self._note(Event(time, law, before, after))
        none = np.zeros(self.layout.size)
        row = none if cause is None else cause.row
        jumped = self._cross(meeting.jump, states, meeting.states, row, z)
        return meeting.states, jumped

    def _note(self, event: Event) -> None:
        if event.time > 0.0:  # at the start it only says what the first state is
            self.events.append(event)

    def _cross(
        self,
        jump: Array,
        states: tuple[str, ...],
        following: tuple[str, ...],
        guard: Array,
        z: Array,
    ) -> Array:
        """Carry state and perturbations through a switch."""
        jumped: Array = jump @ z
        fields = self._flow(states).matrix @ z, self._flow(following).matrix @ jumped
        self.perturbations.cross(jump, fields, guard, z)
        return jumped

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
        self.perturbations.see(track)
        half = step // 2
        for steps, rest in ((half, 0.0), (step - half, part)):
            carry = flow.powers[steps]
            self.perturbations.carry(flow.within(carry, rest) if rest else carry)

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
                self.minima.append(Minimum(at, guards[which].law, height))
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
