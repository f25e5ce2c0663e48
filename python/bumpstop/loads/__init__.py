"""What drives the structure: forces and initial states."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.lazy import lazy_names

if TYPE_CHECKING:
    from bumpstop.loads.force import NodalForce
    from bumpstop.loads.gravity import Gravity
    from bumpstop.loads.initial import ModalState, RigidRotation

__all__ = ["Gravity", "ModalState", "NodalForce", "RigidRotation"]

__getattr__ = lazy_names(
    __name__,
    {
        "Gravity": "gravity",
        "ModalState": "initial",
        "NodalForce": "force",
        "RigidRotation": "initial",
    },
)
