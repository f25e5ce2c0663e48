"""What drives the structure: forces, motions of its supports, and initial states."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.lazy import lazy_names

if TYPE_CHECKING:
    from bumpstop.loads.accelerogram import Accelerogram
    from bumpstop.loads.base_motion import BaseMotion
    from bumpstop.loads.density import SpectralDensity
    from bumpstop.loads.expression import Expression
    from bumpstop.loads.force import NodalForce
    from bumpstop.loads.gravity import Gravity
    from bumpstop.loads.initial import ModalState, RigidRotation
    from bumpstop.loads.line_force import LineForce
    from bumpstop.loads.moving_force import MovingForce
    from bumpstop.loads.nodal_state import NodalState
    from bumpstop.loads.product import Product
    from bumpstop.loads.random_signal import RandomSignal
    from bumpstop.loads.shaft_rotation import ShaftRotation
    from bumpstop.loads.static_state import StaticState
    from bumpstop.loads.support_motion import SupportMotion
    from bumpstop.loads.sweep import Sweep
    from bumpstop.loads.time import Harmonic, Polynomial, TimeTable
    from bumpstop.loads.translation import RigidTranslation
    from bumpstop.loads.turbulence import Turbulence
    from bumpstop.loads.unbalance import Unbalance

__all__ = [
    "Accelerogram",
    "BaseMotion",
    "Expression",
    "Gravity",
    "Harmonic",
    "LineForce",
    "ModalState",
    "MovingForce",
    "NodalForce",
    "NodalState",
    "Polynomial",
    "Product",
    "RandomSignal",
    "RigidRotation",
    "RigidTranslation",
    "ShaftRotation",
    "SpectralDensity",
    "StaticState",
    "SupportMotion",
    "Sweep",
    "TimeTable",
    "Turbulence",
    "Unbalance",
]

__getattr__ = lazy_names(
    __name__,
    {
        "Accelerogram": "accelerogram",
        "BaseMotion": "base_motion",
        "Expression": "expression",
        "Gravity": "gravity",
        "Harmonic": "time",
        "LineForce": "line_force",
        "ModalState": "initial",
        "MovingForce": "moving_force",
        "NodalForce": "force",
        "NodalState": "nodal_state",
        "Polynomial": "time",
        "Product": "product",
        "RandomSignal": "random_signal",
        "RigidRotation": "initial",
        "RigidTranslation": "translation",
        "ShaftRotation": "shaft_rotation",
        "SpectralDensity": "density",
        "StaticState": "static_state",
        "SupportMotion": "support_motion",
        "Sweep": "sweep",
        "TimeTable": "time",
        "Turbulence": "turbulence",
        "Unbalance": "unbalance",
    },
)
