"""Lumped masses: a diagonal mass matrix, for explicit schemes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.sparse import SparseMatrix

if TYPE_CHECKING:
    from bumpstop.structure.model import LinearModel

__all__ = ["lumped_mass"]


def lumped_mass(model: LinearModel) -> SparseMatrix:
    """Return the masses of a model with none shared by two dofs, diagonal on all its dofs.

    A displacement gets the sum of its row over the displacements along the same axis, so that
    every translation has the momentum that it had; a rotation keeps its own inertia. Frequencies
    come out differently from those of the consistent matrix, by as much as the mesh is coarse
    (O. C. Zienkiewicz, R. L. Taylor, The Finite Element Method, 5th edition, 2000, vol. 1,
    appendix I).

    Raises
    ------
    InputError
        If a row sum is negative: such a mass matrix cannot be lumped like this.

    Examples
    --------
    >>> from bumpstop import Beam, Material, Rectangle, Structure
    >>> bar = Beam("AB", nodes=("A", "B"), elements=2, section=Rectangle(height=0.1, width=0.1),
    ...            material=Material(young_modulus=1e9, poisson_ratio=0.0, density=1000.0))
    >>> mass = lumped_mass(Structure(nodes={"A": (0, 0, 0), "B": (2, 0, 0)}, beams=[bar]))
    >>> mass.diagonal()[[0, 1, 6]].round(9).tolist()  # dx and dy of A, dx of a neighbour
    [5.0, 5.0, 5.0]
    """
    mass = model.mass
    axes = np.array([DOFS.index(dof) for _, dof in model.dofs])
    kept = (axes[mass.rows] == axes[mass.columns]) & (axes[mass.rows] < 3)
    kept |= mass.rows == mass.columns
    diagonal = np.zeros(mass.shape[0])
    np.add.at(diagonal, mass.rows[kept], mass.values[kept])
    if (diagonal < 0.0).any():
        node, dof = model.dofs[int(np.argmin(diagonal))]
        what = f"cannot be lumped: the mass of {node} {dof} would be negative"
        raise InputError(what, key="mass", value="lumped", hint='take mass = "consistent"')
    every = np.arange(len(diagonal))
    return SparseMatrix.from_triplets(mass.shape, every, every, diagonal)
