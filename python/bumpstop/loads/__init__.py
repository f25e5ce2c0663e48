"""What drives the structure: forces and initial states."""

from bumpstop.loads.force import NodalForce
from bumpstop.loads.gravity import Gravity
from bumpstop.loads.initial import ModalState, RigidRotation

__all__ = ["Gravity", "ModalState", "NodalForce", "RigidRotation"]
