"""Assembly: a model made of components that are joined."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bumpstop.arguments import FloatArray, Vector, all_of, did_you_mean, listed, name, one_of
from bumpstop.errors import InputError
from bumpstop.modal.substructure.coupling import Coupling, coupling
from bumpstop.modal.substructure.interfaces import Interfaces
from bumpstop.modal.substructure.joint import Joint
from bumpstop.modal.substructure.part import Part
from bumpstop.modal.substructure.placed import Placed
from bumpstop.structure.dofs import DOFS, Dof
from bumpstop.structure.drawn import Line
from bumpstop.structure.echelon import null_space
from bumpstop.structure.forms import LinearForm
from bumpstop.structure.gauge import Gauge
from bumpstop.structure.sparse import IndexArray, SparseMatrix
from bumpstop.structure.support import Support

if TYPE_CHECKING:
    from bumpstop.structure.beam_element import BeamElement

__all__ = ["Assembly"]


class _Reach(NamedTuple):
    """The rows of a part, and how the independent coordinates that reach it move them."""

    rows: slice
    coordinates: IndexArray
    shapes: FloatArray


@dataclass(frozen=True, eq=False, kw_only=True)
class Assembly:
    """Reduced components, each placed as often as needed and joined at interface nodes.

    An assembly is a linear model like a ``Structure``: ``ModalBasis.from_structure`` gives
    its coupled modes, and stops, loads, gauges and outputs name its nodes and points with the
    part before them: ``"left.B"``, ``"left.AB@0.3"``. It can be a component of a larger one.

    Its dofs are those of all nodes of all parts, along the global axes, and after those of each
    part the amplitudes of its inner shapes, named ``("left", "mode 1")``.

    Parameters
    ----------
    parts
        The components in their places, by name.
    joints
        Which interface nodes move as one: ``Joint`` or just two names, ``("left.B",
        "right.A")``.
    supports
        What is held of interface nodes, along and about the global axes.
    join_coincident
        Whether interface nodes of different parts at the same place are joined too, with all
        their dofs.

    Raises
    ------
    InputError
        If a name is unknown, or nodes are joined that are at different places, have different
        dofs or are joined already.

    Examples
    --------
    Two bays make a beam twice as long.

    >>> from bumpstop import Beam, Component, Material, ModalBasis, Placed, Rectangle, Structure
    >>> from bumpstop import craig_bampton
    >>> steel = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
    >>> bar = Rectangle(height=0.02, width=0.02)
    >>> beam = Beam("AB", nodes=("A", "B"), elements=4, material=steel, section=bar)
    >>> bay = Structure(nodes={"A": (0, 0, 0), "B": (1, 0, 0)}, beams=[beam])
    >>> reduced = craig_bampton(Component(bay, interface=["A", "B"]), modes=4)
    >>> whole = Assembly(
    ...     parts={"left": Placed(reduced), "right": Placed(reduced, at=(1, 0, 0))},
    ...     joints=[("left.B", "right.A")],
    ...     supports=[Support(nodes="left.A", fixed=("dx", "dy", "dz", "drx", "dry", "drz"))],
    ... )
    >>> ModalBasis.from_structure(whole, modes=2).frequencies.round(3)
    array([4.191, 4.191])
    """

    parts: Mapping[str, Placed]
    joints: Sequence[Joint | tuple[str, str]] = ()
    supports: Sequence[Support] = ()
    join_coincident: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "parts", _checked_parts(self.parts))
        object.__setattr__(self, "joints", listed("joints", self.joints))
        object.__setattr__(self, "supports", all_of("supports", Support, self.supports))
        if len(self.free) == 0:
            raise InputError("hold everything", key="supports")

    @cached_property
    def dofs(self) -> tuple[Dof, ...]:
        """Node and dof of each row."""
        return tuple(dof for part in self._parts.values() for dof in part.dofs)

    @property
    def nodes(self) -> dict[str, Vector]:
        """Coordinates of the nodes of all parts that their users named, in m."""
        return {node: at for part in self._parts.values() for node, at in part.nodes.items()}

    @property
    def lines(self) -> list[Line]:
        """The beams of all parts, as they are drawn."""
        return [line for part in self._parts.values() for line in part.lines]

    @cached_property
    def joined(self) -> tuple[Joint, ...]:
        """All joints, those found by place too."""
        given = [_joint(number, item) for number, item in enumerate(self.joints)]
        found = self._interfaces.coincident(given) if self.join_coincident else []
        return (*given, *found)

    @cached_property
    def free(self) -> IndexArray:
        """Numbers of the independent dofs, ascending; amplitudes of inner shapes are among them."""
        return self._coordinate_rows[self._coupling.leading]

    @cached_property
    def expansion(self) -> SparseMatrix:
        """All dofs by the independent ones, (dofs, free dofs): the recovery of the parts."""
        pieces = []
        for reach in self._reaches:
            row, column = np.nonzero(reach.shapes)
            places = row + reach.rows.start, reach.coordinates[column]
            pieces.append((*places, reach.shapes[row, column]))
        return _summed((len(self.dofs), len(self.free)), pieces)

    @cached_property
    def stiffness(self) -> SparseMatrix:
        """Stiffness matrices of the parts, joints and supports not yet applied."""
        return self._beside_each_other("stiffness")

    @cached_property
    def mass(self) -> SparseMatrix:
        """Mass matrices of the parts."""
        return self._beside_each_other("mass")

    @cached_property
    def damping(self) -> SparseMatrix:
        """Damping matrices of the parts."""
        return self._beside_each_other("damping")

    @cached_property
    def gyroscopic(self) -> SparseMatrix:
        """Gyroscopic matrices of the parts."""
        return self._beside_each_other("gyroscopic")

    @cached_property
    def circulatory(self) -> SparseMatrix:
        """Circulatory matrices of the parts."""
        return self._beside_each_other("circulatory")

    def reduced(self, matrix: SparseMatrix) -> SparseMatrix:
        """Return expansion' @ matrix @ expansion, for a matrix that couples no two parts."""
        sign = matrix.mirror_sign()
        pieces = []
        for reach in self._reaches:
            own = matrix.restricted(np.arange(reach.rows.start, reach.rows.stop))
            block = reach.shapes.T @ (own @ reach.shapes)
            if sign is not None:
                block = 0.5 * (block + sign * block.T)
            row, column = np.nonzero(block)
            places = reach.coordinates[row], reach.coordinates[column]
            pieces.append((*places, block[row, column]))
        return _summed((len(self.free), len(self.free)), pieces)

    def rigid_shapes(self) -> FloatArray:
        """Return all motions that strain nothing, by the independent dofs, (free dofs, r).

        They are the rigid motions of the parts, as far as joints and supports let them
        combine: exact, and with the mechanisms that hinges leave.
        """
        rigid = np.zeros((len(self._coordinate_rows), 0))
        for part, place in zip(self._parts.values(), self._coordinates.values(), strict=True):
            own = np.zeros((len(rigid), part.rigid.shape[1]))
            own[place] = part.rigid / np.abs(part.rigid).max(axis=0)
            rigid = np.hstack([rigid, own])
        allowed: FloatArray = rigid @ null_space(self._equations @ rigid)
        return allowed[self._coupling.leading]

    def displacement_form(self, node: str, dof: str) -> LinearForm:
        """Return one dof of a node, or of a point along a beam, as a form of all dofs.

        The amplitude of an inner shape is read with the part's name: ``"left", "mode 1"``.

        Raises
        ------
        InputError
            If the part, the node or the dof is unknown.
        """
        if (node, dof) in self._amplitudes:
            return LinearForm(np.array([self._amplitudes[node, dof]]), np.ones(1))
        one_of("dof", dof, DOFS)
        part, inner = self._split(node, "node")
        return self._form(part, self._parts[part].displacement_form(inner, dof))

    def strain_form(self, gauge: Gauge) -> LinearForm:
        """Return a gauge's axial strain as a form of all dofs; its beam is ``"left.AB"``.

        Raises
        ------
        InputError
            If the part or the beam is unknown, or the gauge is not on it.
        """
        part, beam = self._split(gauge.beam, "beam")
        return self._form(part, self._parts[part].strain_form(replace(gauge, beam=beam)))

    def section_forms(self, beam: str, at: float) -> tuple[LinearForm, ...]:
        """Return the forces in a section of a beam, ``"left.AB"``, as `Structure` does.

        Raises
        ------
        InputError
            If the part or the beam is unknown, or the section is not on it.
        """
        part, inner = self._split(beam, "beam")
        return tuple(self._form(part, f) for f in self._parts[part].section_forms(inner, at))

    def beam_element(self, beam: str, at: float) -> BeamElement:
        """Return the element of a beam, ``"left.AB"``, that a place is in, as `Structure` does.

        Raises
        ------
        InputError
            If the part or the beam is unknown, or the place is not on it.
        """
        part, inner = self._split(beam, "beam")
        return self._parts[part].beam_element(inner, at)

    def stress_form(self, gauge: Gauge) -> LinearForm:
        """Return the axial stress of a fibre as a form of all dofs; see `strain_form`.

        Raises
        ------
        InputError
            As `strain_form` does.
        """
        part, beam = self._split(gauge.beam, "beam")
        return self._form(part, self._parts[part].stress_form(replace(gauge, beam=beam)))

    def beam_nodes(self, beam: str) -> tuple[str, ...]:
        """Return the nodes of a beam, ``"left.AB"``, from end to end.

        Raises
        ------
        InputError
            If the part or the beam is unknown.
        """
        part, inner = self._split(beam, "beams")
        return self._parts[part].beam_nodes(inner)

    def beam_axes(self, beam: str) -> FloatArray:
        """Return the local axes of a beam, ``"left.AB"``, one a row, (3, 3).

        Raises
        ------
        InputError
            If the part or the beam is unknown.
        """
        part, inner = self._split(beam, "beams")
        return self._parts[part].beam_axes(inner)

    def position(self, node: str) -> Vector:
        """Return where a node, or a point along a beam, is at rest, in m.

        Raises
        ------
        InputError
            If the part or the node is unknown.
        """
        part, inner = self._split(node, "node")
        return self._parts[part].position(inner)

    def rigid_field(
        self,
        *,
        translation: Vector = (0.0, 0.0, 0.0),
        rotation: Vector = (0.0, 0.0, 0.0),
        about: Vector = (0.0, 0.0, 0.0),
    ) -> FloatArray:
        """Return a small rigid motion of the whole assembly, one value a dof.

        Parameters
        ----------
        translation
            Along the global axes, in m; or in m/s for a velocity, m/s2 for gravity.
        rotation
            About the global axes, in rad (rad/s, rad/s2).
        about
            Where the axes of rotation meet, in m.
        """
        moved = np.array(translation, dtype=float) - np.cross(rotation, about)
        turned = np.array(rotation, dtype=float)
        return np.concatenate([part.rigid_field(moved, turned) for part in self._parts.values()])

    @cached_property
    def _parts(self) -> dict[str, Part]:
        return {name: Part(name, placed) for name, placed in self.parts.items()}

    @cached_property
    def _rows(self) -> dict[str, slice]:
        return _slices(self._parts, [len(part.dofs) for part in self._parts.values()])

    @cached_property
    def _coordinates(self) -> dict[str, slice]:
        sizes = [len(part.coordinate_rows) for part in self._parts.values()]
        return _slices(self._parts, sizes)

    @cached_property
    def _coordinate_rows(self) -> IndexArray:
        """The row of each coordinate of each part."""
        return np.concatenate(
            [self._rows[name].start + part.coordinate_rows for name, part in self._parts.items()]
        )

    @cached_property
    def _interfaces(self) -> Interfaces:
        return Interfaces(self._parts, self._coordinates)

    @cached_property
    def _amplitudes(self) -> dict[Dof, int]:
        """The rows that are no dof of a node along a global axis."""
        return {dof: row for row, dof in enumerate(self.dofs) if dof[1] not in DOFS}

    @cached_property
    def _equations(self) -> FloatArray:
        """What joints and supports demand to be zero, (equations, coordinates)."""
        return self._interfaces.equations(self.joined, self.supports)

    @cached_property
    def _coupling(self) -> Coupling:
        """The coordinates of all parts, in the order of their rows, by the independent ones."""
        return coupling(self._equations)

    @cached_property
    def _reaches(self) -> list[_Reach]:
        ties = self._coupling.expansion
        reaches = []
        for part in self._parts.values():
            place = self._coordinates[part.name]
            own = (ties.rows >= place.start) & (ties.rows < place.stop)
            reached = np.unique(ties.columns[own])
            here = np.zeros((place.stop - place.start, len(reached)))
            columns = np.searchsorted(reached, ties.columns[own])
            here[ties.rows[own] - place.start, columns] = ties.values[own]
            reaches.append(_Reach(self._rows[part.name], reached, part.shapes @ here))
        return reaches

    def _split(self, name: str, key: str) -> tuple[str, str]:
        """Return the part and the name inside it that a name tells."""
        part, point, inner = name.partition(".")
        if part not in self._parts or not point:
            hint = did_you_mean(part, self._parts) + ", as in 'part.node'"
            raise InputError("unknown part", key=key, value=name, hint=hint)
        return part, inner

    def _form(self, part: str, form: LinearForm) -> LinearForm:
        """Return a form of a part's rows as one of all rows."""
        return LinearForm(form.dofs + self._rows[part].start, form.weights)

    def _beside_each_other(self, kind: str) -> SparseMatrix:
        """Return the matrices of the parts as the blocks of one."""
        blocks = [(self._rows[name].start, part.matrix(kind)) for name, part in self._parts.items()]
        rows = np.concatenate([start + block.rows for start, block in blocks])
        columns = np.concatenate([start + block.columns for start, block in blocks])
        values = np.concatenate([block.values for _, block in blocks])
        return SparseMatrix.from_triplets((len(self.dofs),) * 2, rows, columns, values)


def _checked_parts(parts: object) -> dict[str, Placed]:
    if not isinstance(parts, Mapping) or not parts:
        raise InputError("must name at least one placed component", key="parts", value=parts)
    for part, placed in parts.items():
        if "." in name("parts", part) or "@" in part:
            raise InputError("a part cannot have '.' or '@' in its name", key="parts", value=part)
        if not isinstance(placed, Placed):
            hint = "such as Placed(component, at=(1, 0, 0))"
            raise InputError("must be placed", key=f"parts.{part}", value=placed, hint=hint)
    return dict(parts)


def _joint(number: int, item: object) -> Joint:
    if isinstance(item, Joint):
        return item
    if not isinstance(item, list | tuple) or len(item) != 2:
        what = "must be a Joint or the names of two nodes"
        raise InputError(what, key=f"joints[{number}]", value=item)
    return Joint(*item)


def _slices(names: Iterable[str], sizes: Sequence[int]) -> dict[str, slice]:
    """Return where each of several stretches stands when they follow each other."""
    ends = np.cumsum(sizes).tolist()
    return {
        name: slice(end - size, end) for name, size, end in zip(names, sizes, ends, strict=True)
    }


def _summed(
    shape: tuple[int, int], pieces: Iterable[tuple[IndexArray, IndexArray, FloatArray]]
) -> SparseMatrix:
    """Return the matrix of pieces, each rows, columns and values."""
    rows, columns, values = (np.concatenate(parts) for parts in zip(*pieces, strict=True))
    return SparseMatrix.from_triplets(shape, rows, columns, values)
