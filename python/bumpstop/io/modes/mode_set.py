"""ModeSet: modes as files give them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bumpstop.arguments import FloatArray, not_negative, one_of, positive, refuse_twins
from bumpstop.errors import InputError
from bumpstop.modal.basis import ModalBasis
from bumpstop.modal.damping import Damping
from bumpstop.modal.selected import chosen, range_of, require_modes
from bumpstop.modal.selection import AllModes, ModeSelection, mode_selection
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
        modes: int | str | ModeSelection | None = None,
        damping: Damping | None = None,
        modal_mass: float | Sequence[float] | None = None,
    ) -> ModalBasis:
        """Return a modal basis.

        Parameters
        ----------
        modes
            How many modes to take, the lowest ones; ``ModesInBand``, ``ModesAround``; all of
            them where left out.
        damping
            Ratio of critical damping, one for all modes or one for each that is taken, or a
            rule such as ``RayleighDamping``; what the file says where left out.
        modal_mass
            Modal mass in kg, one for all modes or one for each that is taken; what the
            file says where left out.

        Raises
        ------
        InputError
            If there are fewer modes than wanted or none in the band, or nobody tells the modal
            masses.
        """
        taken = self._taken(AllModes() if modes is None else mode_selection(modes))
        mass = modal_mass if modal_mass is not None else _masses(self.modal_mass, taken)
        return ModalBasis.from_modes(
            frequency=self.frequency[taken].tolist(),
            damping=self.damping[taken].tolist() if damping is None else damping,
            modal_mass=mass,
            shapes={
                dof: row[taken].tolist() for dof, row in zip(self.dofs, self.shapes, strict=True)
            },
        )

    def _taken(self, selection: ModeSelection) -> IndexArray:
        """Return the numbers of the selected modes, by their frequencies."""
        most = len(self.frequency)
        asked = getattr(selection, "count", 0)
        if asked > most:
            hint = f"the file has {most}"
            raise InputError("more modes than the file has", key="modes", value=asked, hint=hint)
        order = np.argsort(self.frequency, kind="stable")
        omega2 = (2.0 * np.pi * self.frequency[order]) ** 2
        inside = range_of(selection, omega2).holds(omega2)
        require_modes(len(inside), selection)
        return order[inside[chosen(selection, omega2[inside])]]


def _masses(modal_mass: FloatArray | None, modes: IndexArray) -> list[float]:
    if modal_mass is None:
        hint = "the file does not tell what the shapes are scaled to"
        raise InputError("is missing", key="modal_mass", hint=hint)
    return list(modal_mass[modes])
