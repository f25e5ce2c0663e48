"""What a law tells the judges: forces and guards in each of its states, and what follows them.

Everything is written for floats and for decimals alike; ``one`` is the number one of that kind.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING, Protocol

from ...problem import Array
from .form import Form, T

if TYPE_CHECKING:
    from bumpstop import _core


class Law(Protocol):
    """A local law with named states; unless it says so it is soft and remembers nothing."""

    @property
    def coordinates(self) -> tuple[tuple[Array, float], ...]:
        """Rows and offsets of the local coordinates, ``row . q + offset``."""

    @property
    def restitution(self) -> float | None:
        """Part of the speed that comes back where the first coordinate is zero; None if soft."""
        return None

    def start(self, value: Callable[[Form[T]], T], one: T) -> str:
        """Return the state told by the motion at the start; a guard at zero may switch at once."""

    def forces(self, state: str, one: T) -> tuple[Form[T], ...]:
        """Return the force along each local coordinate that has one."""

    def guards(self, state: str, one: T) -> list[tuple[str, Form[T]]]:
        """Return what is positive as long as a state lasts, and the state that is tried then."""

    def follow(self, state: str, tried: str, sign: Callable[[str, Form[T]], int], one: T) -> str:
        """Return the state that follows.

        ``sign`` tells the sign that a function has if the law goes on in a state, 0 for one that
        is zero to rounding.
        """
        return tried

    def memory(self, before: str, tried: str, after: str, one: T) -> Form[T] | None:
        """Return what is remembered from a switch on; None if that stays."""
        return None

    def holds(self, state: str) -> bool:
        """Return whether the first coordinate is held at zero by a reaction."""
        return False

    def core(self) -> "_core.Law":
        """Return the same law of the core."""
