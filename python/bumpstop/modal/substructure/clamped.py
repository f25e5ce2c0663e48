"""A model with some of its independent dofs held as well."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from bumpstop.arguments import FloatArray, Vector
from bumpstop.structure.dofs import Dof
from bumpstop.structure.echelon import null_space
from bumpstop.structure.forms import LinearForm
from bumpstop.structure.model import LinearModel
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["ClampedModel"]


class ClampedModel:
    """A model whose ``held`` independent dofs cannot move; a linear model itself.

    Parameters
    ----------
    model
        The model.
    held
        Numbers of the dofs among its independent ones.
    """

    def __init__(self, model: LinearModel, held: IndexArray) -> None:
        self.model = model
        self.held = held

    @cached_property
    def moving(self) -> IndexArray:
        """Numbers of the dofs that stay independent, among those of the model."""
        moving = np.ones(len(self.model.free), dtype=bool)
        moving[self.held] = False
        return np.flatnonzero(moving)

    @property
    def dofs(self) -> tuple[Dof, ...]:
        """Node and dof of each row."""
        return self.model.dofs

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

    @property
    def damping(self) -> SparseMatrix:
        """Damping matrix of the model."""
        return self.model.damping

    @property
    def gyroscopic(self) -> SparseMatrix:
        """Gyroscopic matrix of the model."""
        return self.model.gyroscopic

    @property
    def circulatory(self) -> SparseMatrix:
        """Circulatory matrix of the model."""
        return self.model.circulatory

    def reduced(self, matrix: SparseMatrix) -> SparseMatrix:
        """Return expansion' @ matrix @ expansion."""
        return self.model.reduced(matrix).restricted(self.moving)

    def rigid_shapes(self) -> FloatArray:
        """Return the motions that strain nothing and leave the held dofs where they are."""
        rigid = self.model.rigid_shapes()
        return (rigid @ null_space(rigid[self.held]))[self.moving]

    def displacement_form(self, node: str, dof: str) -> LinearForm:
        """Return one dof of a node as a form of all dofs."""
        return self.model.displacement_form(node, dof)

    def position(self, node: str) -> Vector:
        """Return where a node is at rest, in m."""
        return self.model.position(node)

    def rigid_field(
        self,
        *,
        translation: Vector = (0.0, 0.0, 0.0),
        rotation: Vector = (0.0, 0.0, 0.0),
        about: Vector = (0.0, 0.0, 0.0),
    ) -> FloatArray:
        """Return a small rigid motion of all dofs, those that are held too."""
        return self.model.rigid_field(translation=translation, rotation=rotation, about=about)
