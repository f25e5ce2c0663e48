"""The coordinate that a law acts along: a direction at a node, or a weighted sum of dofs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Self

import numpy as np

from bumpstop.arguments import FloatArray, Vector, name, vector
from bumpstop.errors import InputError
from bumpstop.projection import ROTATIONS, TRANSLATIONS, direction_row, require_inertia
from bumpstop.structure.dofs import Dof

if TYPE_CHECKING:
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Law
    from bumpstop.structure.cut import Cut
    from bumpstop.structure.model import LinearModel

__all__ = ["Coordinate", "Terms", "coordinates_of", "unit"]

Terms = Mapping[Dof, float]
"""The weight of each (node, dof)."""


@dataclass(frozen=True)
class Coordinate:
    """What a law sees of the motion.

    Parameters
    ----------
    node
        The node; where there are terms, the node of the first of them.
    direction
        Unit vector; where there are terms, that of the first node's.
    other
        The node whose motion is taken off; None for that against the ground.
    terms
        Instead of these: weights by (node, dof).
    """

    node: str
    direction: Vector
    other: str | None = None
    terms: Terms | None = None

    @classmethod
    def of(
        cls,
        node: object,
        key: str,
        direction: object,
        other: object = None,
        terms: Terms | None = None,
    ) -> Self:
        """Check what a user says: either node and direction (called ``key``), or terms."""
        if terms is None:
            if node is None or direction is None:
                what = f"must have a node and its {key}, or terms"
                raise InputError(what, key="node" if node is None else key)
            where = None if other is None else name("other", other)
            if where == node:
                raise InputError("must be another node", key="other", value=other)
            return cls(name("node", node), unit(key, direction), where)
        for given, value in (("node", node), (key, direction), ("other", other)):
            if value is not None:
                raise InputError("is told by the terms already", key=given, value=value)
        return cls._of_terms(terms)

    @classmethod
    def _of_terms(cls, terms: Terms) -> Self:
        from bumpstop.structure.relation import Relation

        checked = Relation(terms).terms
        node = next(iter(checked))[0]
        kinds = [TRANSLATIONS, ROTATIONS]
        weights = [[checked.get((node, dof), 0.0) for dof in dofs] for dofs in kinds]
        x, y, z = weights[0] if any(weights[0]) else weights[1]
        return cls(node, unit("terms", (x, y, z)), None, checked)

    @property
    def dofs(self) -> tuple[Dof, ...]:
        """The (node, dof) that it is made of."""
        if self.terms is not None:
            return tuple(self.terms)
        nodes = [self.node] if self.other is None else [self.node, self.other]
        both = list(zip(TRANSLATIONS, self.direction, strict=True))
        return tuple((node, dof) for node in nodes for dof, part in both if part != 0.0)

    @property
    def main_dof(self) -> Dof:
        """The (node, dof) that it tells most of."""
        if self.terms is not None:
            return next(iter(self.terms))
        sizes = [abs(part) for part in self.direction]
        return self.node, TRANSLATIONS[sizes.index(max(sizes))]

    def row(self, basis: ModalBasis) -> FloatArray:
        """Return the coordinate per unit of each modal displacement, (N,).

        Raises
        ------
        InputError
            If the basis has no shape at a node, or no mode moves along the coordinate.
        """
        if self.terms is None:
            row = direction_row(basis, self.node, self.direction)
            if self.other is not None:
                row = row - direction_row(basis, self.other, self.direction)
        else:
            row = np.zeros(len(basis.omega2))
            for (node, dof), weight in self.terms.items():
                row += weight * basis.row(node, dof)
            require_inertia(basis, self.terms)
        return row

    def nodal_force(self, model: LinearModel) -> FloatArray:
        """Return a unit force along the coordinate on each dof of a model, (dofs,)."""
        total = np.zeros(len(model.dofs))
        for (node, dof), weight in self._weights.items():
            if weight != 0.0:
                form = model.displacement_form(node, dof)
                np.add.at(total, form.dofs, weight * form.weights)
        return total

    def inside(self, cut: Cut) -> FloatArray:
        """Return what a unit force does inside an element, where it acts on points of it, (r,)."""
        total: FloatArray = 0.0 * cut.kernel(cut.at)[:, 0]
        for (node, dof), weight in self._weights.items():
            total += cut.of_point(node, {dof: weight})
        return total

    @property
    def _weights(self) -> dict[Dof, float]:
        """The weight of each dof."""
        if self.terms is not None:
            return dict(self.terms)
        along = list(zip(TRANSLATIONS, self.direction, strict=True))
        weights = {(self.node, dof): part for dof, part in along}
        if self.other is not None:
            weights |= {(self.other, dof): -part for dof, part in along}
        return weights


def coordinates_of(law: Law, basis: ModalBasis) -> list[Coordinate]:
    """Return the coordinates of a law, in the order in which the core tells forces.

    Stops on a plane have that of their normal and, with friction, that of sliding; round ones two
    across their axis and, with friction, the axis; laws of one's own all their directions.
    """
    several: Sequence[Coordinate] | None = getattr(law, "coordinates", None)
    if several is not None:
        return list(several)
    own = law.coordinate
    if getattr(law, "friction", None) is not None:
        from bumpstop.laws.friction import sliding_coordinate

        return [own, sliding_coordinate(basis, own, getattr(law, "sliding", None))]
    further = getattr(law, "further_directions", ())
    return [own, *(Coordinate(own.node, direction, own.other) for direction in further)]


def unit(key: str, value: object) -> Vector:
    """Return a vector of length one along a given one."""
    x, y, z = vector(key, value)
    length = math.hypot(x, y, z)
    if length == 0.0:
        raise InputError("must not be the zero vector", key=key, value=value)
    return (x / length, y / length, z / length)
