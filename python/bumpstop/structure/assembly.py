"""From the matrices of parts to the matrices of the structure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray
from bumpstop.structure.inertia import definite_dofs
from bumpstop.structure.mesh import Mesh
from bumpstop.structure.pattern import Pattern
from bumpstop.structure.sparse import IndexArray, SparseMatrix
from bumpstop.structure.strains import strains_of

__all__ = ["KINDS", "Assembler", "Block", "Contribution", "Part"]

KINDS = ("stiffness", "mass", "damping", "gyroscopic", "circulatory")
"""The matrices of a structure, by the names of its attributes."""


class Contribution(Protocol):
    """Matrices of a few equal or similar elements, in global axes."""

    @property
    def nodes(self) -> IndexArray:
        """Numbers of the nodes of each element, (elements, m)."""

    def strains(self, mesh: Mesh) -> FloatArray | None:
        """Return sums of dofs that each element's stiffness resists, (elements, sums, 6 m).

        None where every element resists all but the motions of a rigid body.
        """

    def massive(self) -> NDArray[np.bool_]:
        """Return which dofs of an element have inertia in whatever way they move, (6 m,)."""

    def has(self, kind: str) -> bool:
        """Tell whether they have one of the ``KINDS`` that is not zero."""

    def matrix(self, kind: str) -> FloatArray:
        """Return one of the ``KINDS`` that they have, (elements, 6 m, 6 m)."""


@dataclass(frozen=True, eq=False)
class Block:
    """Matrices that one part adds to the structure's, in global axes, on six dofs a node.

    Parameters
    ----------
    joined
        Numbers of the part's nodes, (m,).
    stiffness, mass, damping
        Symmetric matrices (6 m, 6 m); None is 0.
    gyroscopic, circulatory
        Skew-symmetric matrices that multiply velocities and displacements; None is 0.
    """

    joined: IndexArray
    stiffness: FloatArray | None = None
    mass: FloatArray | None = None
    damping: FloatArray | None = None
    gyroscopic: FloatArray | None = None
    circulatory: FloatArray | None = None

    @property
    def nodes(self) -> IndexArray:
        """Numbers of the nodes of its one element, (1, m)."""
        return self.joined[np.newaxis]

    def strains(self, mesh: Mesh) -> FloatArray | None:
        """Return sums of dofs that the stiffness resists, (1, sums, 6 m)."""
        sums = strains_of(self.matrix("stiffness")[0], mesh.positions[self.joined])
        return None if sums is None else sums[np.newaxis]

    def massive(self) -> NDArray[np.bool_]:
        """Return which dofs have inertia in whatever way they move, (6 m,)."""
        return definite_dofs(self.matrix("mass")[0])

    def has(self, kind: str) -> bool:
        """Tell whether the matrix of that name is given."""
        return getattr(self, kind) is not None

    def matrix(self, kind: str) -> FloatArray:
        """Return the matrix of that name, (1, 6 m, 6 m)."""
        matrix: FloatArray = getattr(self, kind)
        return matrix[np.newaxis]


class Part(Protocol):
    """A part of few nodes: all that a structure asks of a mass, a spring or a bearing."""

    def block(self, mesh: Mesh) -> Block:
        """Return the part's matrices on nodes of ``mesh``."""


class Assembler:
    """Adds up the matrices of parts.

    Parameters
    ----------
    parts
        What has matrices; they are added in this order.
    nodes
        Number of nodes.
    """

    def __init__(self, parts: Sequence[Contribution], nodes: int) -> None:
        self.parts = tuple(parts)
        self._nodes = nodes
        self._patterns: dict[tuple[bool, ...], Pattern] = {}

    def matrix(self, kind: str) -> SparseMatrix:
        """Return the sum of all parts' matrices of one of the ``KINDS``."""
        has = tuple(part.has(kind) for part in self.parts)
        if not any(has):
            return SparseMatrix.zeros(6 * self._nodes)
        given = [part for part, contributes in zip(self.parts, has, strict=True) if contributes]
        if has not in self._patterns:
            # Mass and stiffness mostly come from the same parts, and so share a pattern.
            self._patterns[has] = Pattern.of(self._nodes, [part.nodes for part in given])
        pattern = self._patterns[has]
        values = np.zeros(pattern.size)
        for number, part in enumerate(given):
            np.add.at(values, pattern.entries(number).ravel(), part.matrix(kind).ravel())
        return pattern.matrix(values)
