"""How flexible structures vibrate when they hit stops: exact, certified, fast.

Names are imported when they are first used, so that ``import bumpstop`` costs next to nothing.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bumpstop.errors import BumpstopError, ComputationError, InputError
    from bumpstop.io.case import Case, load_case
    from bumpstop.laws.obstacle import Plane
    from bumpstop.laws.stop import Stop
    from bumpstop.loads.force import NodalForce
    from bumpstop.loads.gravity import Gravity
    from bumpstop.loads.initial import ModalState, RigidRotation
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Problem
    from bumpstop.response import Response
    from bumpstop.simulate import simulate
    from bumpstop.structure.beam import Beam
    from bumpstop.structure.gauge import Gauge
    from bumpstop.structure.link import RigidLink
    from bumpstop.structure.mass import PointMass
    from bumpstop.structure.material import Material
    from bumpstop.structure.matrices import Matrices
    from bumpstop.structure.relation import Relation
    from bumpstop.structure.sections.circle import Circle
    from bumpstop.structure.sections.general import GeneralSection
    from bumpstop.structure.sections.rectangle import Rectangle
    from bumpstop.structure.sections.section import Section
    from bumpstop.structure.sections.tube import Tube
    from bumpstop.structure.structure import Structure
    from bumpstop.structure.support import Support

__version__ = "0.1.0"

__all__ = [
    "Beam",
    "BumpstopError",
    "Case",
    "Circle",
    "ComputationError",
    "Gauge",
    "GeneralSection",
    "Gravity",
    "InputError",
    "Material",
    "Matrices",
    "ModalBasis",
    "ModalState",
    "NodalForce",
    "Plane",
    "PointMass",
    "Problem",
    "Rectangle",
    "Relation",
    "Response",
    "RigidLink",
    "RigidRotation",
    "Section",
    "Stop",
    "Structure",
    "Support",
    "Tube",
    "load_case",
    "simulate",
]

_HOME = {
    "Beam": "structure.beam",
    "BumpstopError": "errors",
    "Case": "io.case",
    "Circle": "structure.sections.circle",
    "ComputationError": "errors",
    "Gauge": "structure.gauge",
    "GeneralSection": "structure.sections.general",
    "Gravity": "loads.gravity",
    "InputError": "errors",
    "Material": "structure.material",
    "Matrices": "structure.matrices",
    "ModalBasis": "modal.basis",
    "ModalState": "loads.initial",
    "NodalForce": "loads.force",
    "Plane": "laws.obstacle",
    "PointMass": "structure.mass",
    "Problem": "problem",
    "Relation": "structure.relation",
    "Rectangle": "structure.sections.rectangle",
    "Response": "response",
    "RigidLink": "structure.link",
    "RigidRotation": "loads.initial",
    "Section": "structure.sections.section",
    "Stop": "laws.stop",
    "Structure": "structure.structure",
    "Support": "structure.support",
    "Tube": "structure.sections.tube",
    "load_case": "io.case",
    "simulate": "simulate",
}
"""Where each public name lives."""


class _Package(ModuleType):
    """Keeps ``bumpstop.simulate`` the function, although a module has the same name."""

    def __setattr__(self, name: str, value: object) -> None:
        # On import of a submodule, Python binds it in its package under its last name.
        if not (name in _HOME and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
