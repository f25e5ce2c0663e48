"""Local laws: the few places where the structure is not linear."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.lazy import lazy_names

if TYPE_CHECKING:
    from bumpstop.laws.circle_stop import CircleStop
    from bumpstop.laws.friction import Friction
    from bumpstop.laws.hertz_stop import HertzStop
    from bumpstop.laws.plane_stop import PlaneStop
    from bumpstop.laws.polar_stop import PolarStop
    from bumpstop.laws.rigid_stop import RigidStop
    from bumpstop.laws.spring import SpringLaw
    from bumpstop.laws.stop import Stop
    from bumpstop.laws.zener_damper import ZenerDamper

__all__ = [
    "CircleStop",
    "Friction",
    "HertzStop",
    "PlaneStop",
    "PolarStop",
    "RigidStop",
    "SpringLaw",
    "Stop",
    "ZenerDamper",
]

_HOME = {
    "CircleStop": "circle_stop",
    "Friction": "friction",
    "HertzStop": "hertz_stop",
    "PlaneStop": "plane_stop",
    "PolarStop": "polar_stop",
    "RigidStop": "rigid_stop",
    "SpringLaw": "spring",
    "Stop": "stop",
    "ZenerDamper": "zener_damper",
}

__getattr__ = lazy_names(__name__, _HOME)
