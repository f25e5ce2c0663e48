"""ModeSet: modes as files give them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bumpstop.arguments import FloatArray, not_negative, one_of, positive, refuse_twins
from bumpstop.errors import InputError
from bumpstop.modal.basis import ModalBasis
from bumpstop.modal.damping import Damping
from bumpstop.structure.dofs import DOFS, Dof
from bumpstop.structure.sparse import IndexArray

__all__ = ["ModeSet"]


@dataclass(frozen=True, eq=False)
class ModeSet:
    """Modes from a file; N is their number.

    Parameters
    ----------
    frequency
        Natural frequencies in Hz, (N,).
    damping
        Ratios of critical damping, (N,); zero where the file says nothing.
    modal_mass
        Modal masses in kg that belong to the shapes, (N,); None where the file does not tell
        them, so that a user must.
    dofs
        Node and dof of each row of ``shapes``.
    shapes
        Components of the modes, (rows, N), in m/m and rad/m.

    Raises
    ------
    InputError
        If a frequency or damping is negative, a modal mass not positive, or a dof unknown or
        there twice.
    """

    frequency: FloatArray
    damping: FloatArray
    modal_mass: FloatArray | None
    dofs: tuple[Dof, ...]
    shapes: FloatArray

    def __post_init__(self) -> None:
        refuse_twins("dofs", [".".join(dof) for dof in self.dofs])
        for _, dof in self.dofs:
            one_of("dof", dof, DOFS)
        for key, values in (("frequency", self.frequency), ("damping", self.damping)):
            for value in values:
                not_negative(key, float(value))
        if self.modal_mass is not None:
            for value in self.modal_mass:
                positive("modal_mass", float(value))

    def basis(
        self,
        *,
        modes: int | None = None,
        damping: Damping | None = None,
        modal_mass: float | Sequence[float] | None = None,
    ) -> ModalBasis:
        """Return a modal basis.

        Parameters
        ----------
        modes
            How many modes to take, the lowest ones; all where left out.
        damping
            Ratio of critical damping, one for all modes or one for each that is taken, or a
            rule such as ``RayleighDamping``; what the file says where left out.
        modal_mass
            Modal mass in kg, one for all modes or one for each that is taken; what the
            file says where left out.

        Raises
        ------
        InputError
            If there are fewer modes than wanted, or nobody tells the modal masses.
        """
        count = len(self.frequency) if modes is None else modes
        if count > len(self.frequency):
            hint = f"the file has {len(self.frequency)}"
            raise InputError("more modes than the file has", key="modes", value=modes, hint=hint)
        lowest = np.argsort(self.frequency, kind="stable")[:count]
        mass = modal_mass if modal_mass is not None else _taken(self.modal_mass, lowest)
        return ModalBasis.from_modes(
            frequency=self.frequency[lowest].tolist(),
            damping=self.damping[lowest].tolist() if damping is None else damping,
            modal_mass=mass,
            shapes={
                dof: row[lowest].tolist() for dof, row in zip(self.dofs, self.shapes, strict=True)
            },
        )


def _taken(modal_mass: FloatArray | None, modes: IndexArray) -> list[float]:
    if modal_mass is None:
        hint = "the file does not tell what the shapes are scaled to"
        raise InputError("is missing", key="modal_mass", hint=hint)
    return list(modal_mass[modes])
