"""Local laws: the few places where the structure is not linear."""

from bumpstop.laws.obstacle import Plane
from bumpstop.laws.stop import Stop

__all__ = ["Plane", "Stop"]
