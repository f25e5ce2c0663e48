"""Part: a placed component as an assembly sees it, in global axes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray, Vector
from bumpstop.errors import InputError
from bumpstop.modal.substructure.placed import Placed
from bumpstop.modal.substructure.turning import mixed_dofs, turnable, turning_matrix
from bumpstop.structure.dofs import DOFS, Dof
from bumpstop.structure.drawn import DrawnModel, Line
from bumpstop.structure.forms import LinearForm
from bumpstop.structure.gauge import Gauge
from bumpstop.structure.model import BeamModel, SectionModel, StrainModel
from bumpstop.structure.sparse import IndexArray, SparseMatrix

if TYPE_CHECKING:
    from bumpstop.structure.beam_element import BeamElement

__all__ = ["Part"]


class Part:
    """One placed component, its matrices and shapes turned to the global axes.

    Its rows are the dofs of its nodes, and after them the coordinates that are no dof of a
    node along a global axis: amplitudes of inner shapes, and dofs of interfaces that have too
    few of them to be turned.

    Parameters
    ----------
    name
        What the assembly calls it.
    placed
        The component and its place.

    Raises
    ------
    InputError
        If it is turned in a way of which its nodes do not know all dofs.
    """

    def __init__(self, name: str, placed: Placed) -> None:
        self.name = name
        self._placed = placed
        self._axes = placed.axes
        self._reduced = placed.component
        self._component = placed.component.component
        self._model = placed.component.component.model
        try:
            self._turning = turning_matrix(self._model.dofs, self._axes)
        except InputError as error:
            raise InputError(error.what, key=f"parts.{name}.{error.key}") from error

    @cached_property
    def dofs(self) -> tuple[Dof, ...]:
        """Node and dof of each row; the part's name stands before the nodes'."""
        nodes = [(f"{self.name}.{node}", dof) for node, dof in self._model.dofs]
        left = [self._boundary[number] for number in np.flatnonzero(~self._turnable)]
        own = [(f"{self.name}.{node}", f"own {dof}") for node, dof in left]
        inner = [(self.name, label) for label in self._reduced.labels]
        return (*nodes, *own, *inner)

    @cached_property
    def coordinate_rows(self) -> IndexArray:
        """The row of each coordinate, ascending."""
        return np.sort(self._given_rows)

    @cached_property
    def shapes(self) -> FloatArray:
        """Displacement of all rows for each coordinate, (rows, coordinates)."""
        shapes = np.zeros((len(self.dofs), self._reduced.shapes.shape[1]))
        shapes[: len(self._model.dofs)] = self._turning @ self._reduced.shapes
        shapes[:, : len(self._boundary)] = shapes[:, : len(self._boundary)] @ self._turned.T
        # Exactly one, which a rotation times its inverse need not be.
        shapes[self._given_rows] = np.eye(shapes.shape[1])
        return shapes[:, self._given_rows.argsort()]

    @cached_property
    def rigid(self) -> FloatArray:
        """Coordinates of the rigid motions that the part has by itself, (coordinates, motions)."""
        rigid = self._reduced.rigid.copy()
        rigid[: len(self._boundary)] = self._turned @ rigid[: len(self._boundary)]
        return rigid[self._given_rows.argsort()]

    @property
    def interface(self) -> list[str]:
        """The interface nodes, without the part's name."""
        return list(dict.fromkeys(node for node, _ in self._boundary))

    @property
    def nodes(self) -> dict[str, Vector]:
        """Where the nodes are that the component's user named, with the part's name, in m."""
        known = self._model.nodes if isinstance(self._model, DrawnModel) else self.interface
        return {f"{self.name}.{node}": self.position(node) for node in known}

    @property
    def lines(self) -> list[Line]:
        """The beams, with the part's name."""
        lines = self._model.lines if isinstance(self._model, DrawnModel) else []
        return [line._replace(name=f"{self.name}.{line.name}") for line in lines]

    def matrix(self, kind: str) -> SparseMatrix:
        """Return one of the matrices of the model, by its name, on the part's rows."""
        matrix: SparseMatrix = getattr(self._model, kind)
        turned = matrix.congruent(self._turning.transposed())
        size = len(self.dofs)
        return SparseMatrix.from_triplets((size, size), turned.rows, turned.columns, turned.values)

    def tie(self, node: str, dof: str) -> FloatArray | None:
        """Return a global dof of an interface node by the coordinates, (coordinates,).

        All zero where the component's own supports hold it, and None where it is not known:
        where the node does not have the dof, or its interface does not list it.
        """
        if not all((node, own) in self._known for own in mixed_dofs(dof, self._axes)):
            return None
        row: FloatArray = self.shapes[self._rows[f"{self.name}.{node}", dof]]
        return row

    def displacement_form(self, node: str, dof: str) -> LinearForm:
        """Return one dof of a node, along or about a global axis, as a form of the rows."""
        kind, axis = divmod(DOFS.index(dof), 3)
        field = np.zeros(len(self._model.dofs))
        with self._named():
            for own in np.flatnonzero(self._axes[axis]):
                form = self._model.displacement_form(node, DOFS[3 * kind + own])
                np.add.at(field, form.dofs, self._axes[axis, own] * form.weights)
        return self._form(field)

    def beam_nodes(self, beam: str) -> tuple[str, ...]:
        """Return the nodes of a beam, named without the part's name; theirs have it."""
        with self._named():
            if not isinstance(self._model, BeamModel):
                raise InputError("the component has no beams", key="beams", value=beam)
            return tuple(f"{self.name}.{node}" for node in self._model.beam_nodes(beam))

    def beam_axes(self, beam: str) -> FloatArray:
        """Return the local axes of a beam, named without the part's name, one a row, (3, 3)."""
        with self._named():
            if not isinstance(self._model, BeamModel):
                raise InputError("the component has no beams", key="beams", value=beam)
            own: FloatArray = self._model.beam_axes(beam) @ self._axes.T
        return own

    def strain_form(self, gauge: Gauge) -> LinearForm:
        """Return the strain of a gauge, its beam without the part's name, as a form of the rows."""
        with self._named():
            if not isinstance(self._model, StrainModel):
                raise InputError("the component has no beams", key="beam", value=gauge.beam)
            form = self._model.strain_form(gauge)
        return self._of_rows(form)

    def section_forms(self, beam: str, at: float) -> tuple[LinearForm, ...]:
        """Return the forces in a section, along the beam's own axes, as forms of the rows."""
        with self._named():
            forms = self._sections(beam).section_forms(beam, at)
        return tuple(self._of_rows(form) for form in forms)

    def beam_element(self, beam: str, at: float) -> BeamElement:
        """Return the element of a beam that a place is in, its axes turned to the global ones."""
        with self._named():
            found = self._sections(beam).beam_element(beam, at)
        return replace(found, axes=found.axes @ self._axes.T)

    def stress_form(self, gauge: Gauge) -> LinearForm:
        """Return the axial stress of a fibre as a form of the rows; see `strain_form`."""
        with self._named():
            form = self._sections(gauge.beam).stress_form(gauge)
        return self._of_rows(form)

    def _sections(self, beam: str) -> SectionModel:
        if not isinstance(self._model, SectionModel):
            raise InputError("the component has no beams", key="beam", value=beam)
        return self._model

    def _of_rows(self, form: LinearForm) -> LinearForm:
        """Return a form of the component's dofs as one of the rows."""
        field = np.zeros(len(self._model.dofs))
        np.add.at(field, form.dofs, form.weights)
        return self._form(field)

    def position(self, node: str) -> Vector:
        """Return where a node is at rest, in m."""
        with self._named():
            own = self._model.position(node)
        return _vector(np.array(self._placed.at) + self._axes @ np.array(own))

    def rigid_field(self, translation: FloatArray, rotation: FloatArray) -> FloatArray:
        """Return a rigid motion of the rows, turning about the global origin."""
        carried = translation + np.cross(rotation, self._placed.at)
        own = self._model.rigid_field(
            translation=_vector(self._axes.T @ carried), rotation=_vector(self._axes.T @ rotation)
        )
        field = np.zeros(len(self.dofs))
        field[: len(own)] = self._turning @ own
        return field

    @cached_property
    def _given_rows(self) -> IndexArray:
        """The row of each coordinate, in the order of the reduced component."""
        is_dof = np.zeros(self._reduced.shapes.shape[1], dtype=bool)
        is_dof[: len(self._turnable)] = self._turnable
        rows = np.empty(len(is_dof), dtype=np.intp)
        rows[is_dof] = self._component.boundary[self._turnable]
        rows[~is_dof] = np.arange(len(self._model.dofs), len(self.dofs))
        return rows

    @cached_property
    def _boundary(self) -> list[Dof]:
        return [self._model.dofs[row] for row in self._component.boundary]

    @cached_property
    def _turnable(self) -> NDArray[np.bool_]:
        return turnable(self._boundary, self._axes)

    @cached_property
    def _turned(self) -> FloatArray:
        """Matrix that turns the boundary's coordinates, those that can be turned."""
        turned = np.eye(len(self._boundary))
        dofs = [self._boundary[number] for number in np.flatnonzero(self._turnable)]
        place = np.ix_(self._turnable, self._turnable)
        turned[place] = turning_matrix(dofs, self._axes).to_dense()
        return turned

    @cached_property
    def _rows(self) -> dict[Dof, int]:
        return {dof: row for row, dof in enumerate(self.dofs)}

    @cached_property
    def _known(self) -> frozenset[Dof]:
        """Dofs that the boundary's coordinates tell: those of the interface, and held ones."""
        moving = set(self._model.expansion.rows.tolist())
        held = [dof for row, dof in enumerate(self._model.dofs) if row not in moving]
        return frozenset([*held, *self._boundary])

    def _form(self, field: FloatArray) -> LinearForm:
        """Return weights of the component's own dofs as a form of the rows."""
        turned = self._turning @ field
        dofs = np.flatnonzero(turned)
        return LinearForm(dofs, turned[dofs])

    @contextmanager
    def _named(self) -> Iterator[None]:
        """Put the part's name before the names that its model complains of."""
        try:
            yield
        except InputError as error:
            value = error.value
            if isinstance(value, str) and error.key in ("node", "beam", "beams", None):
                value = f"{self.name}.{value}"
            raise InputError(error.what, key=error.key, value=value, hint=error.hint) from error


def _vector(components: FloatArray) -> Vector:
    x, y, z = components.tolist()
    return x, y, z
