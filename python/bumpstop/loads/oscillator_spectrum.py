"""What accelerations of a base do to oscillators of all frequencies."""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray

__all__ = ["Oscillators"]


class Oscillators:
    """Oscillators on a base whose acceleration is a straight line between even samples.

    A recurrence follows them exactly (N. C. Nigam, P. C. Jennings, Bulletin of the
    Seismological Society of America 59, 1969).

    Parameters
    ----------
    frequencies
        Without damping, in Hz, (F,).
    damping
        Their ratio of critical damping, below one.
    step
        Between samples, in s.
    """

    def __init__(self, frequencies: FloatArray, damping: float, step: float) -> None:
        self._omega = (2.0 * np.pi * frequencies).tolist()
        self._filters = [_recurrence(omega, damping, step) for omega in self._omega]

    def pseudo_acceleration(self, acceleration: FloatArray) -> FloatArray:
        """Return the largest displacement from the base times omega2 of each, (F,).

        Parameters
        ----------
        acceleration
            Of the base in m/s2, (K,). Displacements are looked at where the samples are.
        """
        from scipy.signal import lfilter

        moved = (lfilter(above, below, acceleration) for above, below in self._filters)
        return np.array(
            [omega**2 * np.abs(each).max() for omega, each in zip(self._omega, moved, strict=True)]
        )


def _recurrence(omega: float, damping: float, step: float) -> tuple[FloatArray, FloatArray]:
    """Return the filter from base acceleration to displacement, above and below the line."""
    from scipy.linalg import expm

    # State: displacement, velocity, acceleration of the base and its slope.
    state = np.zeros((4, 4))
    state[0, 1] = state[2, 3] = 1.0
    state[1, :3] = (-(omega**2), -2.0 * damping * omega, -1.0)
    grown = expm(state * step)
    own = grown[:2, :2]
    last = grown[:2, 3] / step
    first = grown[:2, 2] - last
    above = np.array(
        [
            last[0],
            first[0] - own[1, 1] * last[0] + own[0, 1] * last[1],
            own[0, 1] * first[1] - own[1, 1] * first[0],
        ]
    )
    return above, np.array([1.0, -np.trace(own), np.linalg.det(own)])
