"""How much each mode takes part in motions of the whole structure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, listed
from bumpstop.errors import InputError
from bumpstop.modal.unit_motion import unit_motion
from bumpstop.structure.dofs import DOFS

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis

__all__ = ["Participation", "generalised_mass", "participation"]

TRANSLATIONS = DOFS[:3]


@dataclass(frozen=True, eq=False)
class Participation:
    """Participation factors and effective masses of N modes in D directions.

    The effective mass of a mode is the part of the structure's mass that pushes on its base as
    that mode when the base shakes (R. W. Clough and J. Penzien, Dynamics of Structures, 2nd
    edition, McGraw-Hill, 1993, section 26-4). Over a complete basis it adds up to the mass that
    is not held.

    Parameters
    ----------
    directions
        Any of ``dx dy dz drx dry drz``, D of them; rotations are about the origin.
    factors
        Modal force of an acceleration of 1 m/s2 (1 rad/s2), (N, D), in kg^0.5 (kg^0.5 m); a
        mode is counted with unit modal mass.
    total
        Mass of the whole structure, what is held included, (D,), in kg; moments of inertia
        about the origin in kg m2.
    """

    directions: tuple[str, ...]
    factors: FloatArray = field(repr=False)
    total: FloatArray

    @property
    def effective_mass(self) -> FloatArray:
        """Effective mass of each mode in each direction, (N, D), in kg and kg m2."""
        return self.factors**2

    @property
    def fractions(self) -> FloatArray:
        """Effective masses relative to the total one, (N, D); 0 where there is no mass."""
        nothing = np.zeros(self.factors.shape)
        return np.divide(self.effective_mass, self.total, out=nothing, where=self.total > 0.0)

    @property
    def sums(self) -> FloatArray:
        """Share of the total mass that all the modes together take, (D,)."""
        sums: FloatArray = self.fractions.sum(axis=0)
        return sums


def participation(basis: ModalBasis, directions: Sequence[str] = TRANSLATIONS) -> Participation:
    """Return how much the modes take part in motions of the whole structure.

    Parameters
    ----------
    basis
        Modes of a structure.
    directions
        Any of ``dx dy dz drx dry drz``.

    Raises
    ------
    InputError
        If a direction is unknown, or the basis has no structure and thus no mass matrix.

    Examples
    --------
    >>> from bumpstop import ModalBasis, PointMass, Structure, Support
    >>> point = Structure(nodes={"P": (0, 0, 0)}, masses=[PointMass("m", node="P", mass=4.0)],
    ...     supports=[Support(nodes="P", fixed=("dz", "drx", "dry", "drz"))])
    >>> part = participation(ModalBasis.from_structure(point, modes=2))
    >>> part.effective_mass.tolist(), part.sums.tolist()
    ([[4.0, 0.0, 0.0], [0.0, 4.0, 0.0]], [1.0, 1.0, 0.0])
    """
    model = basis.model
    if model is None or basis.mass_rows is None:  # has_masses, but so that mypy sees it
        hint = "make it from a structure or from matrices"
        raise InputError("this basis knows no masses", key="basis", hint=hint)
    names = listed("directions", directions)
    motions = np.stack([unit_motion(model, name) for name in names], axis=1)
    total = np.sum(motions * (model.mass @ motions), axis=0)
    return Participation(names, basis.mass_rows @ motions, total)


def generalised_mass(basis: ModalBasis) -> FloatArray:
    """Return the mass of each mode when its largest displacement is one, (N,), in kg.

    The largest displacement is that of a translation; a mode that has none is counted by its
    largest rotation, in kg m2.
    """
    along = np.array([dof in TRANSLATIONS for _, dof in basis.dofs])
    moved, turned = (
        np.abs(basis.shapes[rows]).max(axis=0, initial=0.0) for rows in (along, ~along)
    )
    largest = np.where(moved > 0.0, moved, turned)
    masses: FloatArray = 1.0 / largest**2
    return masses
