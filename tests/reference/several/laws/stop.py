"""A unilateral spring and damper."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...problem import CLOSED, OPEN, RELEASED, Array
from .form import Form, T
from .law import Law

if TYPE_CHECKING:
    from bumpstop import _core


@dataclass(frozen=True)
class Stop(Law):
    """``F = max(0, -k d - c d')`` below ``d = gap + row . q``."""

    row: Array
    gap: float
    stiffness: float
    damping: float = 0.0

    @property
    def coordinates(self) -> tuple[tuple[Array, float], ...]:
        """The distance."""
        return ((self.row, self.gap),)

    def push(self, one: T) -> Form[T]:
        """Return the force while it is closed."""
        distance, number = Form.coordinate(0, one), type(one)
        return -(distance * number(self.stiffness) + distance.rate() * number(self.damping))

    def start(self, value: Callable[[Form[T]], T], one: T) -> str:
        """Look whether it is inside, and whether it pushes."""
        if value(Form.coordinate(0, one)) >= 0:
            return OPEN
        return CLOSED if value(self.push(one)) > 0 else RELEASED

    def forces(self, state: str, one: T) -> tuple[Form[T], ...]:
        """Push while closed."""
        return (self.push(one),) if state == CLOSED else ()

    def guards(self, state: str, one: T) -> list[tuple[str, Form[T]]]:
        """Return the distance while open, the force while closed, both while released."""
        distance = Form.coordinate(0, one)
        push = self.push(one) * (one / type(one)(self.stiffness))
        if state == OPEN:
            return [(CLOSED, distance)]
        if state == CLOSED:
            return [(RELEASED if self.damping > 0 else OPEN, push)]
        return [(OPEN, -distance), (CLOSED, -push)]

    def core(self) -> "_core.Stop":
        """Return the same law of the core."""
        from bumpstop import _core

        return _core.Stop(self.row, self.gap, self.stiffness, self.damping)
