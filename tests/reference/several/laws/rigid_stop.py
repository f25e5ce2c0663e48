"""An obstacle that does not give way."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...problem import OPEN, Array
from .form import Form, T
from .law import Law

if TYPE_CHECKING:
    from bumpstop import _core

RESTING = "resting"


@dataclass(frozen=True)
class RigidStop(Law):
    """``d = gap + row . q >= 0``; at d = 0 its rate turns from d' to ``-returned d'``."""

    row: Array
    gap: float
    returned: float  # the coefficient of restitution

    @property
    def coordinates(self) -> tuple[tuple[Array, float], ...]:
        """The distance."""
        return ((self.row, self.gap),)

    @property
    def restitution(self) -> float:
        """Part of the speed that comes back."""
        return self.returned

    def start(self, value: Callable[[Form[T]], T], one: T) -> str:
        """Nothing starts inside; what starts at the obstacle is looked at as after an impact."""
        return OPEN

    def forces(self, state: str, one: T) -> tuple[Form[T], ...]:
        """Have impulses and reactions, but no force of its own."""
        return ()

    def guards(self, state: str, one: T) -> list[tuple[str, Form[T]]]:
        """Return the distance while open; the reaction, while resting, is the flow's."""
        return [(OPEN, Form.coordinate(0, one))] if state == OPEN else []

    def holds(self, state: str) -> bool:
        """Hold the distance while the structure rests."""
        return state == RESTING

    def core(self) -> "_core.RigidStop":
        """Return the same law of the core."""
        from bumpstop import _core

        return _core.RigidStop(self.row, self.gap, self.returned)
