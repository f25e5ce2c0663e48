"""How it vibrates: eigenmodes and imported modes, as a basis for everything above."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.lazy import lazy_names

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
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

__getattr__ = lazy_names(
    __name__,
    {
        "Campbell": "rotor",
        "ComplexModes": "oscillation",
        "ModalBasis": "basis",
        "Participation": "masses",
        "campbell": "rotor",
        "complex_modes": "oscillation",
        "generalised_mass": "masses",
        "participation": "masses",
    },
)
