"""How it vibrates: eigenmodes and imported modes, as a basis for everything above."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from bumpstop.modal.basis import ModalBasis

if TYPE_CHECKING:
    from bumpstop.modal.masses import Participation, generalised_mass, participation
    from bumpstop.modal.oscillation import ComplexModes, complex_modes
    from bumpstop.modal.rotor import Campbell, campbell

__all__ = [
    "Campbell",
    "ComplexModes",
    "ModalBasis",
    "Participation",
    "campbell",
    "complex_modes",
    "generalised_mass",
    "participation",
]

_HOME = {
    "Campbell": "rotor",
    "ComplexModes": "oscillation",
    "Participation": "masses",
    "campbell": "rotor",
    "complex_modes": "oscillation",
    "generalised_mass": "masses",
    "participation": "masses",
}
"""Where each name lives that no simulation needs: imported when it is first used."""


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
