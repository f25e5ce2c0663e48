"""Several stops and other laws on a modal system under forces in time, as plain arrays."""

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from ..problem import Array
from .laws.law import Law
from .laws.stop import Stop
from .loads import Exosystem, Harmonic, Load, Polynomial, Table

if TYPE_CHECKING:
    from bumpstop._core import History

__all__ = ["SeveralStops", "Stop"]


@dataclass(frozen=True)
class SeveralStops:
    """``q'' + (diag(damping) + coupling) q' + diag(omega2) q = forces + sum of row F``."""

    omega2: Array
    damping: Array
    stops: tuple[Stop, ...]
    duration: float
    displacement: Array
    velocity: Array
    force: Array = field(default_factory=lambda: np.zeros(0))
    loads: tuple[Load, ...] = ()
    coupling: Array | None = None
    others: tuple[Law, ...] = ()  # laws that are numbered after the stops

    def __post_init__(self) -> None:
        """Let no constant force be one of zeros."""
        if self.force.size == 0:
            object.__setattr__(self, "force", np.zeros_like(self.omega2))

    def but(self, **changes: Any) -> Self:
        """Return the same problem with some fields changed."""
        return replace(self, **changes)

    @property
    def laws(self) -> tuple[Law, ...]:
        """The stops and the other laws, as they are numbered in events."""
        return (*self.stops, *self.others)

    def exosystem(self) -> Exosystem:
        """Return the system that makes all forces in time."""
        return Exosystem.of(self.force, self.loads)

    def solve(self, method: str = "exact", rtol: float | None = None) -> "History":
        """Let the core solve it by the exact method, or by an adaptive one."""
        from bumpstop import _core

        polynomials = [
            (load.shape, np.array(load.coefficients))
            for load in self.loads
            if isinstance(load, Polynomial)
        ]
        harmonics = [
            (load.frequency, np.cos(load.phase) * load.shape, -np.sin(load.phase) * load.shape)
            for load in self.loads
            if isinstance(load, Harmonic)
        ]
        tables = [
            (load.shape, load.times, load.values, load.holds)
            for load in self.loads
            if isinstance(load, Table)
        ]
        return _core.simulate(
            _core.System(self.omega2, self.damping, self.coupling),
            [law.core() for law in self.laws],
            _core.Forcing(self.force, polynomials, harmonics, tables),
            self.displacement,
            self.velocity,
            self.duration,
            method,
            tolerances=None if rtol is None else (rtol, None),
        )
