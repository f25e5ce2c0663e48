"""The matrices of beams, computed for many at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray
from bumpstop.errors import InputError
from bumpstop.structure.assembly import Contribution
from bumpstop.structure.beam import Beam
from bumpstop.structure.elements import THEORIES, Slice
from bumpstop.structure.frame import local_axes, turned
from bumpstop.structure.mesh import Mesh
from bumpstop.structure.sparse import IndexArray

if TYPE_CHECKING:
    from bumpstop.structure.elements.varying import VaryingElement

__all__ = ["beam_blocks"]

_ELEMENTS = 4096
"""Elements in a block: few enough for their matrices to stay in the cache."""


def beam_blocks(beams: Sequence[Beam], mesh: Mesh) -> list[Contribution]:
    """Return the matrices of all beams, those that are computed alike together.

    Raises
    ------
    InputError
        If a beam has no length.
    """
    alike: dict[tuple[object, ...], list[Beam]] = {}
    varying = []
    for beam in beams:
        if beam.varies:
            varying.append(beam)
            continue
        kind = THEORIES[beam.theory].element, beam.mass, beam.tension != 0.0
        alike.setdefault(kind, []).append(beam)
    plain = [
        PrismaticBeams(tuple(some), mesh) for group in alike.values() for some in _portions(group)
    ]
    blocks = [*plain, *(VaryingBeam((beam,), mesh) for beam in varying)]
    for block in blocks:
        block.require_length()
    return list(blocks)


def _portions(beams: Sequence[Beam]) -> Iterator[list[Beam]]:
    """Yield beams of about as many elements as a block may have."""
    portion: list[Beam] = []
    elements = 0
    for beam in beams:
        if portion and elements + beam.elements > _ELEMENTS:
            yield portion
            portion, elements = [], 0
        portion.append(beam)
        elements += beam.elements
    yield portion


@dataclass(frozen=True, eq=False)
class PrismaticBeams:
    """Beams of constant section, of the same element and mass matrix, all tight or all slack.

    Matrices are computed when they are asked for, and not kept.

    Parameters
    ----------
    beams
        The beams.
    mesh
        Their nodes.
    """

    beams: tuple[Beam, ...]
    mesh: Mesh

    @cached_property
    def nodes(self) -> IndexArray:
        """Numbers of the two nodes of each element, beam by beam, (elements, 2)."""
        first, last = self._ends
        offset = np.cumsum(self._elements) - self._elements
        place = np.arange(len(self._beam)) - offset[self._beam]
        inner = self._first_inner[self._beam] + place
        left = np.where(place == 0, first[self._beam], inner - 1)
        right = np.where(place == self._elements[self._beam] - 1, last[self._beam], inner)
        return np.stack([left, right], axis=1)

    def require_length(self) -> None:
        """Raise InputError if a beam has no length."""
        if not self._lengths.all():
            raise self.beams[int(self._lengths.argmin())].without_length()

    def strains(self, mesh: Mesh) -> FloatArray | None:  # noqa: ARG002  # the beams know it
        """Return sums of dofs that each element resists, (elements, sums, 12).

        Tension resists the turning of the line between the nodes, so that a tight beam is not
        free of strain in a rigid motion.
        """
        bends, tight = THEORIES[self.beams[0].theory].bends, self.beams[0].tension != 0.0
        if bends and not tight:
            return None
        sums = _apart(range(3)) if tight else _apart([0])
        if bends:
            sums = np.concatenate([sums, _apart([3]), np.eye(12)[[4, 5, 10, 11]]])
        in_global = sums.reshape(-1, 4, 3) @ self._axes[:, np.newaxis]
        of_beams: FloatArray = in_global.reshape(len(self.beams), -1, 12)
        return of_beams[self._beam]

    def massive(self) -> NDArray[np.bool_]:
        """Return which dofs of every element have inertia in whatever way they move, (12,)."""
        turns = THEORIES[self.beams[0].theory].bends
        return np.repeat([True, turns, True, turns], 3)

    @cached_property
    def _spins(self) -> bool:
        return any(beam.spin != 0.0 for beam in self.beams)

    def has(self, kind: str) -> bool:
        """Tell whether the beams have such a matrix."""
        return kind in ("stiffness", "mass") or (kind == "gyroscopic" and self._spins)

    def matrix(self, kind: str) -> FloatArray:
        """Return the matrices of all elements in global axes, (elements, 12, 12).

        Raises
        ------
        InputError
            If they overflow.
        """
        with np.errstate(all="ignore"):
            matrices = turned(self._local(kind), self._axes, skew=kind == "gyroscopic")
        self._refuse_overflow(matrices)
        return matrices if len(matrices) == len(self._beam) else matrices[self._beam]

    def _local(self, kind: str) -> FloatArray:
        """Return the matrix of one element of each beam in local axes, (beams, 12, 12)."""
        element = THEORIES[self.beams[0].theory].element
        length, part = self._lengths / self._elements, self._slices
        if kind == "gyroscopic":
            return element.gyroscopic(length, part, np.array([beam.spin for beam in self.beams]))
        if kind == "mass":
            lumped = self.beams[0].mass == "lumped"
            return (element.lumped_mass if lumped else element.mass)(length, part)
        stiffness = element.stiffness(length, part)
        tension = np.array([beam.tension for beam in self.beams])
        if tension.any():
            stiffness += element.geometric_stiffness(length, part, tension)
        return stiffness

    @cached_property
    def _elements(self) -> IndexArray:
        return np.array([beam.elements for beam in self.beams])

    @cached_property
    def _beam(self) -> IndexArray:
        """Number of the beam that each element belongs to."""
        return np.repeat(np.arange(len(self.beams)), self._elements)

    @cached_property
    def _ends(self) -> tuple[IndexArray, IndexArray]:
        """Numbers of the first and of the last node of each beam."""
        ends = [
            [self.mesh.node(node, f"beams.{beam.name}.nodes") for node in beam.nodes]
            for beam in self.beams
        ]
        first, last = np.array(ends).T
        return first, last

    @property
    def _first_inner(self) -> IndexArray:
        """Number of the first node inside each beam; those after it follow in the mesh."""
        return np.array(
            [self.mesh.node(beam.inner_nodes[0]) if beam.elements > 1 else 0 for beam in self.beams]
        )

    @cached_property
    def _lengths(self) -> FloatArray:
        """Length of each beam in m."""
        first, last = self._ends
        along = self.mesh.positions[last] - self.mesh.positions[first]
        lengths: FloatArray = np.hypot(np.hypot(along[:, 0], along[:, 1]), along[:, 2])
        return lengths

    @cached_property
    def _axes(self) -> FloatArray:
        """Local axes of each beam, (beams, 3, 3)."""
        first, last = (self.mesh.positions[nodes] for nodes in self._ends)
        return local_axes(first, last, np.array([beam.roll for beam in self.beams]))

    @cached_property
    def _slices(self) -> Slice:
        """What a slice of each beam resists and weighs."""
        numbers: dict[tuple[object, ...], int] = {}
        slices: list[Slice] = []
        kinds = []
        for beam in self.beams:
            # By identity, since many beams share few materials and sections.
            key = (id(beam.material), id(beam.section), beam.theory, beam.added_mass)
            if key not in numbers:
                numbers[key] = len(slices)
                slices.append(beam.slice_at(0.0))
            kinds.append(numbers[key])
        return Slice(*np.array(slices).T[:, kinds])

    def _refuse_overflow(self, matrices: FloatArray) -> None:
        good = np.isfinite(matrices).all(axis=(1, 2))
        if not good.all():
            beam = self.beams[min(int(good.argmin()), len(self.beams) - 1)]
            raise InputError(
                "its numbers are too large or too small to compute with",
                key=f"beams.{beam.name}",
                hint="check the units of length, section and material",
            )


@dataclass(frozen=True, eq=False)
class VaryingBeam(PrismaticBeams):
    """One beam of varying section, or with its shear centre off the centroid."""

    def _local(self, kind: str) -> FloatArray:
        """Return the matrices of its elements in local axes, (elements or 1, 12, 12)."""
        if kind not in self._made:
            beam = self.beams[0]
            matrices = [_matrix(element, beam, kind) for element in self._elements_of_beam]
            self._made[kind] = np.array(matrices)
        return self._made[kind]

    @cached_property
    def _made(self) -> dict[str, FloatArray]:
        """Matrices made so far: unlike those of constant sections they take time."""
        return {}

    @cached_property
    def _elements_of_beam(self) -> list[VaryingElement]:
        beam = self.beams[0]
        number = 1 if beam.end_section is None else beam.elements
        return [beam.varying_element(self.mesh, element) for element in range(number)]


def _matrix(element: VaryingElement, beam: Beam, kind: str) -> FloatArray:
    if kind == "gyroscopic":
        return element.gyroscopic(beam.spin)
    if kind == "mass":
        return element.lumped_mass() if beam.mass == "lumped" else element.mass()
    if beam.tension == 0.0:
        return element.stiffness()
    return element.stiffness() + element.geometric_stiffness(beam.tension)


def _apart(dofs: Sequence[int]) -> FloatArray:
    """Return the differences between the two nodes in local dofs, (differences, 12)."""
    own = np.array(dofs)
    differences: FloatArray = np.eye(12)[own + 6] - np.eye(12)[own]
    return differences
