"""Modes among many laws, carried by central differences in the core: what a step takes."""

from collections.abc import Sequence
from time import process_time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bumpstop import _core


class ExplicitMarch:
    """Modes of 1 to 100 Hz that start at random velocities.

    Parameters
    ----------
    laws
        Laws of the core.
    velocity
        Of each mode, in m/s.
    damping
        Of each mode, by its angular frequency.
    steps
        Length of a run.
    """

    def __init__(
        self, laws: Sequence[Any], velocity: NDArray[np.float64], *, damping: float, steps: int
    ) -> None:
        omega = 2.0 * np.pi * np.linspace(1.0, 100.0, len(velocity))
        self._system = _core.System(omega**2, damping * omega)
        self._laws = list(laws)
        self._velocity = velocity
        self._dt = 0.1 / omega[-1]
        self._steps = steps

    def seconds_of_a_step(self) -> float:
        """Return the processor time of one step, what is made once left out.

        Records are dropped at once, so that their memory is used again and not asked for anew.
        """
        few = self._run(self._steps // 4)[0]
        many = self._run(self._steps)[0]
        return (many - few) / (self._steps - self._steps // 4)

    def contacts(self) -> tuple[int, float]:
        """Return how many contacts a run has, and for what part of it a law is closed."""
        _, history = self._run(self._steps)
        impacts = [history.impacts(law) for law in range(len(self._laws))]
        closed = sum(float(np.nansum(each["end"] - each["start"])) for each in impacts)
        number = sum(len(each["start"]) for each in impacts)
        return number, closed / (self._steps * self._dt * len(impacts))

    def _run(self, steps: int) -> tuple[float, _core.History]:
        """Return the processor time of some steps, and what they gave."""
        still = np.zeros_like(self._velocity)
        before = process_time()
        history = _core.simulate(
            self._system,
            self._laws,
            _core.Forcing(still),
            still,
            self._velocity,
            steps * self._dt,
            "central_difference",
            self._dt,
        )
        return process_time() - before, history
