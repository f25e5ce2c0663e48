"""A model with some of its independent dofs held as well."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.echelon import null_space
from bumpstop.structure.model import VibratingModel
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["ClampedModel"]


class ClampedModel:
    """A model whose ``held`` independent dofs cannot move; what modes are computed from.

    Parameters
    ----------
    model
        The model.
    held
        Numbers of the dofs among its independent ones.
    """

    def __init__(self, model: VibratingModel, held: IndexArray) -> None:
        self.model = model
        self.held = held

    @cached_property
    def moving(self) -> IndexArray:
        """Numbers of the dofs that stay independent, among those of the model."""
        moving = np.ones(len(self.model.free), dtype=bool)
        moving[self.held] = False
        return np.flatnonzero(moving)

    @property
    def free(self) -> IndexArray:
        """Numbers of the independent dofs, ascending."""
        return self.model.free[self.moving]

    @cached_property
    def expansion(self) -> SparseMatrix:
        """All dofs by the independent ones."""
        whole = self.model.expansion
        place = np.full(whole.shape[1], -1, dtype=np.intp)
        place[self.moving] = np.arange(len(self.moving))
        columns = place[whole.columns]
        kept = columns >= 0
        shape = (whole.shape[0], len(self.moving))
        return SparseMatrix.from_triplets(
            shape, whole.rows[kept], columns[kept], whole.values[kept]
        )

    @property
    def stiffness(self) -> SparseMatrix:
        """Stiffness matrix of the model."""
        return self.model.stiffness

    @property
    def mass(self) -> SparseMatrix:
        """Mass matrix of the model."""
        return self.model.mass

    def reduced(self, matrix: SparseMatrix) -> SparseMatrix:
        """Return expansion' @ matrix @ expansion."""
        return self.model.reduced(matrix).restricted(self.moving)

    def rigid_shapes(self) -> FloatArray:
        """Return the motions that strain nothing and leave the held dofs where they are."""
        rigid = self.model.rigid_shapes()
        return (rigid @ null_space(rigid[self.held]))[self.moving]
