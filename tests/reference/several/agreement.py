"""How far a run of the core is from a solution whose every event is known."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..problem import Array
from .problem import SeveralStops
from .scan import Event
from .verdict import core_events

SAMPLES = 41


class Oracle(Protocol):
    """What is known of a problem."""

    @property
    def events(self) -> Sequence[Event]:
        """Switches in order of time."""

    def motion(self, times: Array) -> tuple[Array, Array]:
        """Return displacement and velocity, each (time, mode)."""


@dataclass(frozen=True)
class Agreement:
    """Differences between the core and an oracle."""

    found: list[Event]
    same_events: bool  # of each stop: at one instant the order is nobody's business
    event_error: float  # relative to the duration
    state_error: float  # relative to the largest displacement and velocity
    energy_residual: float


def agreement(problem: SeveralStops, oracle: Oracle) -> Agreement:
    """Let the core solve a problem, and compare events, and states between them."""
    history = problem.solve()
    found = core_events(history)
    same, late = True, 0.0
    for stop in range(len(problem.stops)):
        left = [event for event in oracle.events if event.stop == stop]
        right = [event for event in found if event.stop == stop]
        same = same and [(e.before, e.after) for e in left] == [(e.before, e.after) for e in right]
        gaps = [abs(a.time - b.time) for a, b in zip(left, right, strict=False)]
        late = max([late, *gaps])
    times = np.linspace(0.0, problem.duration, SAMPLES)
    errors = [
        float(np.abs(history.motion(times, order) - wanted).max() / (np.abs(wanted).max() or 1.0))
        for order, wanted in enumerate(oracle.motion(times))
    ]
    return Agreement(found, same, late / problem.duration, max(errors), history.energy_residual())
