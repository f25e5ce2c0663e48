"""A stop that rubs along one direction: a spring and a slider in a row, a damper beside them.

The slider stands at the end of the spring. While it sticks it stays where it is; while it slides
the spring carries ``dynamic F``, so that it moves with ``x' - s dynamic F' / kt``.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...problem import CLOSED, OPEN, RELEASED, Array
from .form import Form, T
from .law import Law
from .stop import Stop

if TYPE_CHECKING:
    from bumpstop import _core

STICK = "stick"
SLIP = {1: "slip forward", -1: "slip back"}
HELD = {sign: f"{name}, held by the damper" for sign, name in SLIP.items()}
SIGNS = {name: sign for names in (SLIP, HELD) for sign, name in names.items()}


@dataclass(frozen=True)
class FrictionStop(Law):
    """A stop, the row of its sliding motion, and the stick's spring, damper and coefficients."""

    normal: Stop
    tangent: Array
    static: float
    dynamic: float
    stiffness: float
    damping: float = 0.0

    @property
    def coordinates(self) -> tuple[tuple[Array, float], ...]:
        """The distance and the sliding motion."""
        return (*self.normal.coordinates, (self.tangent, 0.0))

    def _rub(self, state: str, one: T) -> Form[T]:
        """Return the force along the obstacle."""
        number = type(one)
        if state in SIGNS:
            return self.normal.push(one) * (number(-SIGNS[state]) * number(self.dynamic))
        x = Form.coordinate(1, one)
        stretch = x - Form.remembered(one)
        return -(stretch * number(self.stiffness) + x.rate() * number(self.damping))

    def _creep(self, sign: int, one: T, damped: bool) -> Form[T]:
        """Return the slider's velocity, or that of one that carries the damper, along a sign."""
        number = type(one)
        force = self._rub(SLIP[sign], one).rate()
        x = Form.coordinate(1, one)
        if damped:
            force = force + x.rate().rate() * number(self.damping)
        return (x.rate() + force * (one / number(self.stiffness))) * number(sign)

    def start(self, value: Callable[[Form[T]], T], one: T) -> str:
        """Stick where it pushes; whatever is outside the cone breaks loose at once."""
        state = self.normal.start(value, one)
        return STICK if state == CLOSED else state

    def forces(self, state: str, one: T) -> tuple[Form[T], ...]:
        """Push and rub."""
        if state in (OPEN, RELEASED):
            return ()
        return (self.normal.push(one), self._rub(state, one))

    def guards(self, state: str, one: T) -> list[tuple[str, Form[T]]]:
        """Return those of the stop, and the cone or the slider's velocity."""
        if state in (OPEN, RELEASED):
            found = self.normal.guards(state, one)
            return [(STICK if after == CLOSED else after, form) for after, form in found]
        guards: list[tuple[str, Form[T]]] = self.normal.guards(CLOSED, one)
        if state in SIGNS:
            guards.append((STICK, self._creep(SIGNS[state], one, state in HELD.values())))
            return guards
        number = type(one)
        cone = self.normal.push(one) * number(self.static)
        rub = self._rub(STICK, one)
        for sign, name in SLIP.items():
            inside = (cone + rub * number(sign)) * (one / number(self.stiffness))
            guards.append((name, inside))
        return guards

    def follow(self, state: str, tried: str, sign: Callable[[str, Form[T]], int], one: T) -> str:
        """Let the slider decide, and the damper where it alone keeps it going."""
        if tried in (OPEN, RELEASED) or (state not in SIGNS and tried not in SIGNS):
            return tried
        way = SIGNS[state] if state in SIGNS else SIGNS[tried]
        goes_on = sign(SLIP[way], self._creep(way, one, damped=False))
        is_held = sign(HELD[way], self._creep(way, one, damped=True)) > 0
        if state == SLIP[way]:
            return HELD[way] if is_held else STICK
        if state == HELD[way]:
            return SLIP[way] if goes_on > 0 else STICK
        if goes_on >= 0:
            return SLIP[way]
        return HELD[way] if is_held else STICK

    def memory(self, before: str, tried: str, after: str, one: T) -> Form[T] | None:
        """Put the anchor where the node is, or where the force goes on without a jump."""
        if after != STICK:
            return None
        x, number = Form.coordinate(1, one), type(one)
        slides = before if before in SIGNS else tried
        if slides not in SIGNS:
            return x
        carried = self._rub(slides, one) + x.rate() * number(self.damping)
        return x + carried * (one / number(self.stiffness))

    def core(self) -> "_core.FrictionStop":
        """Return the same law of the core."""
        from bumpstop import _core

        return _core.FrictionStop(
            self.normal.core(),
            self.tangent,
            self.static,
            self.dynamic,
            self.stiffness,
            self.damping,
        )
