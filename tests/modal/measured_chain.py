"""A chain of equal masses between equal springs: its modes, in closed form, and its functions."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bumpstop import FrequencyResponse
from bumpstop.modal.frequency_response import DERIVATIVES

MASS, STIFFNESS = 2.0, 1e5


class Chain(NamedTuple):
    omega: NDArray[np.float64]
    damping: NDArray[np.float64]
    shapes: NDArray[np.float64]
    """Of unit modal mass; the first mass moves to the positive side."""

    def functions(
        self,
        kind: str = "displacement",
        *,
        noise: float = 0.0,
        skew: float = 0.0,
        frequency: NDArray[np.float64] | None = None,
    ) -> list[FrequencyResponse]:
        """Return what a force at the first mass moves; noise by the root mean square."""
        if frequency is None:
            frequency = np.linspace(0.0, 80.0, 801)
        s = 2j * np.pi * frequency[:, np.newaxis]
        draw = np.random.default_rng(1)
        found = []
        for number, row in enumerate(self.shapes):
            residue = row * self.shapes[0] * np.exp(1j * skew * number)
            modes = residue / (s**2 + 2.0 * self.damping * self.omega * s + self.omega**2)
            values = modes.sum(axis=1) * s[:, 0] ** DERIVATIVES[kind]
            size = noise * np.sqrt(np.mean(np.abs(values) ** 2) / 2.0)
            values = values + size * (draw.normal(size=(2, len(s))).T @ np.array([1.0, 1j]))
            place = (str(number + 1), "dx")
            found.append(FrequencyResponse(frequency, values, place, ("1", "dx"), kind))
        return found


def chain(masses: int) -> Chain:
    number = np.arange(1, masses + 1)
    angle = np.pi * number / (masses + 1)
    return Chain(
        omega=2.0 * np.sqrt(STIFFNESS / MASS) * np.sin(angle / 2.0),
        damping=np.linspace(0.01, 0.02, masses),
        shapes=np.sqrt(2.0 / (masses + 1) / MASS) * np.sin(np.outer(number, angle)),
    )
