"""What rigid stops in touch do at one instant: impulses, rest and leaving, by trying every set.

Newton's restitution for all at once, in Moreau's form: impulses ``s >= 0`` and rates
``u+ + e u- >= 0``, one of the two zero for each stop; reactions and accelerations likewise.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import product

import numpy as np
from numpy.typing import NDArray

from ..problem import OPEN, Array
from .flow import Flow
from .guards import LEAVES, Guard
from .laws.rigid_stop import RESTING
from .perturbations import TOUCHING, Perturbations

Flags = NDArray[np.bool_]
RESOLUTION = 1e-13  # of the motion: rebounds below it are not followed
TAIL = 1e-8  # of the motion: rebounds below it are not compared one by one


def complementary(matrix: Array, constant: Array) -> Array:
    """Return x with ``x >= 0``, ``w = matrix x + constant >= 0`` and ``x . w = 0``."""
    best, least = np.zeros(constant.size), np.inf
    for chosen in product((False, True), repeat=constant.size):
        some = np.array(chosen, bool)
        x = np.zeros(constant.size)
        x[some] = -np.linalg.pinv(matrix[np.ix_(some, some)], rcond=1e-12) @ constant[some]
        w = matrix @ x + constant
        wrong = max([0.0, *(-x * matrix.diagonal()), *(-w), *np.abs(w[some])])
        if wrong < least:
            best, least = x, wrong
    if least > 1e-9 * (np.abs(constant).max(initial=0.0) or 1.0):
        raise ArithmeticError("the impact has no solution")
    positive: Array = np.maximum(best, 0.0)
    return positive


@dataclass
class Tail:
    """The stretch in which a stop's rebounds come to their end."""

    law: int
    start: float
    end: float


@dataclass
class Meeting:
    """What became of the stops in touch."""

    jump: Array
    states: tuple[str, ...]
    switches: list[tuple[int, str, str]] = field(default_factory=list)


class Contacts:
    """The rigid stops of a problem."""

    def __init__(
        self, perturbations: Perturbations, flow: Callable[[tuple[str, ...]], Flow]
    ) -> None:
        """Find them."""
        self.perturbations, self.flow = perturbations, flow
        self.layout = perturbations.layout
        laws = enumerate(self.layout.laws)
        self.stops = [number for number, law in laws if law.restitution is not None]
        self.latest = dict.fromkeys(self.stops, 0.0)
        self.tails: list[Tail] = []
        self.tangled = False  # two come to their end at once: what follows hangs on the order

    def _touching(self, states: tuple[str, ...], z: Array, cause: Guard | None) -> list[int]:
        found = []
        for law in self.stops:
            distance, zero = self.perturbations.value(self.layout.coordinate(law, 0), z)
            close = abs(distance) <= zero
            if close or states[law] == RESTING or (cause is not None and cause.law == law):
                found.append(law)
        return found

    def _size(self, law: int) -> float:
        row, offset = self.layout.laws[law].coordinates[0]
        return float(np.abs(row).sum()) * self.perturbations.sizes[0] + abs(offset)

    def _see_impact(self, law: int, time: float, rate: float) -> None:
        """Tell where the rebounds of a stop become too low to be compared one by one."""
        since, self.latest[law] = time - self.latest[law], time
        returned = self.layout.laws[law].restitution or 0.0
        if returned == 1.0 or rate <= 0 or since * rate > TAIL * self._size(law):
            return
        end = time + 2 * since / (1 - returned)
        known = [tail for tail in self.tails if tail.law == law and tail.end >= time]
        if known:
            known[-1].end = max(known[-1].end, end)
        else:
            self.tails.append(Tail(law, time, end))
        self.tangled |= any(tail.law != law and tail.end >= time for tail in self.tails)

    def meet(
        self, states: tuple[str, ...], z: Array, time: float, cause: Guard | None
    ) -> Meeting | None:
        """Let those in touch do their work; None where there are none."""
        touching = self._touching(states, z, cause)
        if not touching:
            return None
        n, laws = self.layout.modes, self.layout.laws
        rows = np.array([laws[law].coordinates[0][0] for law in touching])
        returned = np.array([laws[law].restitution or 0.0 for law in touching])
        struck, turn = self._strike(rows, returned, z[n : 2 * n])
        v = turn @ z[n : 2 * n]
        rates = self._rates(rows, v)
        apart = tuple(OPEN if law in touching else state for law, state in enumerate(states))
        moved = z.copy()
        moved[n : 2 * n] = v
        push = self.flow(apart).matrix[n : 2 * n]
        accelerations = rows @ push @ moved
        noise = 1e-12 * np.abs(rows) @ np.abs(push) @ np.abs(moved)
        value, zero = self.perturbations.value(cause.row, z) if cause is not None else (0.0, 0.0)
        leaves = cause is not None and cause.tried == LEAVES and value >= -zero
        free = [not (leaves and cause is not None and law == cause.law) for law in touching]
        sizes = np.array([self._size(law) for law in touching])
        rests, along = _resting(rows, rates, accelerations, noise, returned, np.array(free), sizes)
        if (
            cause is not None
            and cause.tried != LEAVES
            and rates[at := touching.index(cause.law)] == 0
        ):
            rests[at] |= along[at] <= noise[at]  # a higher derivative has led it here
        held = rows[rests]
        turn = turn - held.T @ np.linalg.pinv(held @ held.T, rcond=1e-12) @ held @ turn
        jump = np.eye(self.layout.size)
        jump[n : 2 * n, n : 2 * n] = turn
        now = list(apart)
        meeting = Meeting(jump, ())
        for place, law in enumerate(touching):
            now[law] = RESTING if rests[place] else OPEN
            if struck[place] or now[law] != states[law]:
                meeting.switches.append((law, states[law], now[law]))
            if struck[place]:
                self._see_impact(law, time, 0.0 if rests[place] else float(rates[place]))
        meeting.states = tuple(now)
        return meeting

    def _rates(self, rows: Array, v: Array) -> Array:
        """Return ``R v``, zero where it is rounding."""
        u = rows @ v
        rates: Array = np.where(
            np.abs(u) <= TOUCHING * self.perturbations.sizes[1] * np.abs(rows).sum(axis=1), 0.0, u
        )
        return rates

    def _strike(self, rows: Array, returned: Array, v: Array) -> tuple[Flags, Array]:
        """Return which stops have an impulse, and the matrix that turns the velocities."""
        u = self._rates(rows, v)
        if (u >= 0).all():
            return np.zeros(u.size, bool), np.eye(v.size)
        impulses = complementary(rows @ rows.T, (1 + returned) * u)
        struck = impulses > 0
        some = rows[struck]
        share = np.linalg.pinv(some @ some.T, rcond=1e-12) @ (
            (1 + returned[struck])[:, None] * some
        )
        return struck, np.eye(v.size) - some.T @ share


def _resting(
    rows: Array,
    rates: Array,
    accelerations: Array,
    noise: Array,
    returned: Array,
    free: Flags,
    sizes: Array,
) -> tuple[Flags, Array]:
    """Return which stops are rested on, and the accelerations with their reactions."""
    candidates = free & (rates == 0)
    while True:
        some = rows[candidates]
        reactions = complementary(some @ some.T, accelerations[candidates])
        along = accelerations + rows @ some.T @ reactions
        low = rates * rates <= 2 * -along * RESOLUTION * sizes
        more = free & ~candidates & (returned < 1) & (rates > 0) & (-along > noise) & low
        if not more.any():
            rests = np.zeros(rates.size, bool)
            rests[candidates] = reactions * (some * some).sum(axis=1) > noise[candidates]
            return rests, along
        candidates |= more
