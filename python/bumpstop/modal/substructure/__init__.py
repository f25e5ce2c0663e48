"""Substructures: components that are reduced once, and put together as often as needed."""

from bumpstop.modal.substructure.assembly import Assembly
from bumpstop.modal.substructure.component import Component
from bumpstop.modal.substructure.craig_bampton import craig_bampton
from bumpstop.modal.substructure.free_interface import free_interface
from bumpstop.modal.substructure.joint import Joint
from bumpstop.modal.substructure.placed import Placed
from bumpstop.modal.substructure.reduced import ReducedComponent
from bumpstop.modal.substructure.rotation import Rotation

__all__ = [
    "Assembly",
    "Component",
    "Joint",
    "Placed",
    "ReducedComponent",
    "Rotation",
    "craig_bampton",
    "free_interface",
]
