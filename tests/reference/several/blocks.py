"""Structures side by side that know nothing of each other, taken as one problem.

What is true of each alone is true of all together, although the core, which cannot know, solves
their modes and watches their stops as those of one structure.
"""

from collections.abc import Sequence

import numpy as np

from ..precise import PreciseSolution
from ..problem import Array, StopProblem
from .problem import SeveralStops, Stop
from .scan import Event


def side_by_side(problems: Sequence[StopProblem]) -> SeveralStops:
    """Return one problem of all modes, with one stop for each structure; the shortest duration."""

    def joined(name: str) -> Array:
        together: Array = np.concatenate([getattr(problem, name) for problem in problems])
        return together

    sizes = [problem.omega2.size for problem in problems]
    stops, first = [], 0
    for problem, size in zip(problems, sizes, strict=True):
        row = np.zeros(sum(sizes))
        row[first : first + size] = problem.row
        stops.append(Stop(row, problem.gap, problem.stiffness, problem.stop_damping))
        first += size
    return SeveralStops(
        omega2=joined("omega2"),
        damping=joined("damping"),
        stops=tuple(stops),
        duration=min(problem.duration for problem in problems),
        displacement=joined("displacement"),
        velocity=joined("velocity"),
        force=joined("force"),
    )


class BlockSolution:
    """Fifty digits for structures side by side, each solved alone."""

    def __init__(self, problems: Sequence[StopProblem]) -> None:
        """Solve each up to the shortest duration."""
        duration = min(problem.duration for problem in problems)
        self.parts = [PreciseSolution(problem.but(duration=duration)) for problem in problems]
        self.margin = min(float(part.margin) for part in self.parts)

    @property
    def events(self) -> list[Event]:
        """Switches in order of time."""
        events = [
            Event(time, stop, before, after)
            for stop, part in enumerate(self.parts)
            for time, before, after in part.events
        ]
        return sorted(events, key=lambda event: event.time)

    def motion(self, times: Array) -> tuple[Array, Array]:
        """Return displacement and velocity, each (time, mode)."""
        motions = [part.motion(times) for part in self.parts]
        displacement, velocity = zip(*motions, strict=True)
        return np.hstack(displacement), np.hstack(velocity)
