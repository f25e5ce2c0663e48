"""An elastic spring of several slopes."""

from bisect import bisect_right
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...problem import Array
from .form import Form, T
from .law import Law

if TYPE_CHECKING:
    from bumpstop import _core


@dataclass(frozen=True)
class Spring(Law):
    """``-(f(x) + c x')`` with the slope ``stiffness[i]`` of f between breaks i - 1 and i."""

    row: Array
    breaks: tuple[float, ...]
    stiffness: tuple[float, ...]
    preload: float = 0.0
    damping: float = 0.0

    @property
    def coordinates(self) -> tuple[tuple[Array, float], ...]:
        """The deformation."""
        return ((self.row, 0.0),)

    def _at_origin(self, segment: int, one: T) -> T:
        """Return the force at no deformation of the line that a segment lies on."""
        number = type(one)
        slopes = [number(k) for k in self.stiffness]
        home, force = bisect_right(self.breaks, 0.0), number(self.preload)
        while home != segment:
            step = 1 if segment > home else -1
            edge = number(self.breaks[home if step > 0 else home - 1])
            force += (slopes[home] - slopes[home + step]) * edge
            home += step
        return force

    def start(self, value: Callable[[Form[T]], T], one: T) -> str:
        """Return the segment that the deformation is in."""
        x = float(value(Form.coordinate(0, one)))
        return f"segment {bisect_right(self.breaks, x) + 1}"

    def forces(self, state: str, one: T) -> tuple[Form[T], ...]:
        """Resist along the segment's line."""
        segment, x, number = int(state.split()[1]) - 1, Form.coordinate(0, one), type(one)
        line = x * number(self.stiffness[segment]) + x.rate() * number(self.damping)
        return (-line.plus(self._at_origin(segment, one)),)

    def guards(self, state: str, one: T) -> list[tuple[str, Form[T]]]:
        """Return the ways to both ends of the segment."""
        segment, x, number = int(state.split()[1]) - 1, Form.coordinate(0, one), type(one)
        guards = []
        if segment > 0:
            guards.append((f"segment {segment}", x.plus(-number(self.breaks[segment - 1]))))
        if segment < len(self.breaks):
            guards.append((f"segment {segment + 2}", -x.plus(-number(self.breaks[segment]))))
        return guards

    def core(self) -> "_core.Spring":
        """Return the same law of the core."""
        from bumpstop import _core

        breaks, stiffness = np.array(self.breaks), np.array(self.stiffness)
        return _core.Spring(self.row, breaks, stiffness, self.preload, self.damping)
