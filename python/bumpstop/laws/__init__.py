"""Local laws: the few places where the structure is not linear."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.lazy import lazy_names

if TYPE_CHECKING:
    from bumpstop.laws.buckling_stop import BucklingStop
    from bumpstop.laws.circle_stop import CircleStop
    from bumpstop.laws.cracked_rotor import CrackedRotor
    from bumpstop.laws.damper import DamperLaw
    from bumpstop.laws.force_relation import ForceRelation
    from bumpstop.laws.friction import Friction
    from bumpstop.laws.hardening_spring import HardeningSpring
    from bumpstop.laws.hertz_stop import HertzStop
    from bumpstop.laws.outside_program import OutsideProgram
    from bumpstop.laws.piped_program import PipedProgram
    from bumpstop.laws.plane_stop import PlaneStop
    from bumpstop.laws.polar_stop import PolarStop
    from bumpstop.laws.rigid_stop import RigidStop
    from bumpstop.laws.seismic_device import SeismicDevice
    from bumpstop.laws.spring import SpringLaw
    from bumpstop.laws.stop import Stop
    from bumpstop.laws.user_law import UserLaw
    from bumpstop.laws.zener_damper import ZenerDamper

__all__ = [
    "BucklingStop",
    "CircleStop",
    "CrackedRotor",
    "DamperLaw",
    "ForceRelation",
    "Friction",
    "HardeningSpring",
    "HertzStop",
    "OutsideProgram",
    "PipedProgram",
    "PlaneStop",
    "PolarStop",
    "RigidStop",
    "SeismicDevice",
    "SpringLaw",
    "Stop",
    "UserLaw",
    "ZenerDamper",
]

_HOME = {
    "BucklingStop": "buckling_stop",
    "CircleStop": "circle_stop",
    "CrackedRotor": "cracked_rotor",
    "DamperLaw": "damper",
    "ForceRelation": "force_relation",
    "Friction": "friction",
    "HardeningSpring": "hardening_spring",
    "HertzStop": "hertz_stop",
    "OutsideProgram": "outside_program",
    "PipedProgram": "piped_program",
    "PlaneStop": "plane_stop",
    "PolarStop": "polar_stop",
    "RigidStop": "rigid_stop",
    "SeismicDevice": "seismic_device",
    "SpringLaw": "spring",
    "Stop": "stop",
    "UserLaw": "user_law",
    "ZenerDamper": "zener_damper",
}

__getattr__ = lazy_names(__name__, _HOME)
