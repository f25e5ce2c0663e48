"""One beam-like modal system and one stop, as plain arrays: what the oracles and the core solve."""

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from bumpstop._core import History

Array = NDArray[np.float64]

OPEN, CLOSED, RELEASED = "open", "closed", "released"


@dataclass(frozen=True)
class StopProblem:
    """``q'' + C q' + diag(omega2) q = force + row F`` with ``F = max(0, -k d - c d')`` below d = 0.

    The distance is ``d = gap + row . q``; everything is in SI units.
    """

    omega2: Array
    damping: Array
    row: Array
    stiffness: float
    duration: float
    gap: float = 0.0
    stop_damping: float = 0.0
    force: Array = field(default_factory=lambda: np.zeros(0))
    displacement: Array = field(default_factory=lambda: np.zeros(0))
    velocity: Array = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        """Fill what was left out with zeros."""
        for name in ("force", "displacement", "velocity"):
            if getattr(self, name).size == 0:
                object.__setattr__(self, name, np.zeros_like(self.omega2))

    def but(self, **changes: float | Array) -> Self:
        """Return the same problem with some fields changed."""
        return replace(self, **changes)  # type: ignore[arg-type]  # the field names carry the types

    def solve(self, method: str = "exact", dt: float | None = None) -> "History":
        """Let the core solve it."""
        from bumpstop import _core

        return _core.simulate(
            _core.System(self.omega2, self.damping),
            [_core.Stop(self.row, self.gap, self.stiffness, self.stop_damping)],
            _core.Forcing(self.force),
            self.displacement,
            self.velocity,
            self.duration,
            method,
            dt,
        )
