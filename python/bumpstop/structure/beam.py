"""Straight beams of equal elements."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from bumpstop.arguments import FloatArray, Vector, count, name, one_of
from bumpstop.errors import InputError
from bumpstop.structure.assembly import Block
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.elements import THEORIES
from bumpstop.structure.forms import LinearForm
from bumpstop.structure.frame import local_axes
from bumpstop.structure.material import Material
from bumpstop.structure.mesh import Mesh
from bumpstop.structure.section import Section
from bumpstop.structure.sparse import IndexArray

__all__ = ["MOST_ELEMENTS", "Beam"]

MOST_ELEMENTS = 10_000
"""Most elements of one beam; more is taken for a slip of the keyboard."""


@dataclass(frozen=True)
class Beam:
    """A straight beam between two nodes, meshed into equal elements.

    Nodes inside the beam are called ``AB.1``, ``AB.2``, ...: the beam's name, a dot, and
    their number from the first node on. A point anywhere along it is ``"AB@0.462"``, in m
    from the first node.

    Local x runs from the first node to the second. Local z is the global Z made perpendicular
    to x, and y = z x x, so that a beam along X has the global axes; for a beam parallel to the
    global Z, local y is the global Y.

    Parameters
    ----------
    name
        Name of the beam.
    nodes
        Names of its first and last node.
    elements
        Number of elements.
    material
        What it is made of.
    section
        Its cross section, for instance a ``Rectangle``.
    theory
        Name of the beam theory: ``"timoshenko"``.

    Raises
    ------
    InputError
        If a value cannot be used.
    """

    name: str
    nodes: Sequence[str] = field(kw_only=True)
    elements: int = field(kw_only=True)
    material: Material = field(kw_only=True)
    section: Section = field(kw_only=True)
    theory: str = field(default="timoshenko", kw_only=True)

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", name("name", self.name))
        object.__setattr__(self, "nodes", _two_names(self.nodes))
        object.__setattr__(self, "elements", _element_count(self.elements))
        one_of("theory", self.theory, tuple(THEORIES))
        if not isinstance(self.material, Material):
            raise InputError("must be a Material", key="material", value=self.material)
        if not isinstance(self.section, Section):
            raise InputError("must be a section", key="section", value=self.section)

    @cached_property
    def inner_nodes(self) -> tuple[str, ...]:
        """Names of the mesh nodes inside the beam."""
        return tuple(f"{self.name}.{number}" for number in range(1, self.elements))

    def meshed(self, mesh: Mesh) -> Mesh:
        """Return the mesh with the nodes inside the beam added to it."""
        start, end = self._ends(mesh)
        part = np.arange(1, self.elements)[:, np.newaxis] / self.elements
        return mesh.with_nodes(self.inner_nodes, start + (end - start) * part)

    def length(self, mesh: Mesh) -> float:
        """Return the length in m.

        Raises
        ------
        InputError
            If it is zero.
        """
        start, end = self._ends(mesh)
        length = math.dist(start, end)
        if length == 0.0:
            raise InputError(
                "the beam has no length",
                key=f"beams.{self.name}.nodes",
                value=self.nodes,
                hint="its two nodes must be at different places",
            )
        return length

    def block(self, mesh: Mesh) -> Block:
        """Return the matrices of one element in global axes, and where they go.

        Raises
        ------
        InputError
            If they overflow.
        """
        theory = THEORIES[self.theory]
        part = self._element_length(mesh), self.material, self.section
        to_local = self._to_local(mesh)
        try:
            with np.errstate(over="raise", divide="raise", invalid="raise"):
                stiffness = _turned(theory.stiffness(*part), to_local)
                mass = _turned(theory.mass(*part), to_local)
        except ArithmeticError as error:
            raise InputError(
                "its numbers are too large or too small to compute with",
                key=f"beams.{self.name}",
                hint="check the units of length, section and material",
            ) from error
        return Block(self._element_dofs(mesh), stiffness, mass)

    def require_on(self, mesh: Mesh, at: float, *, key: str, value: object) -> None:
        """Raise InputError if the point ``at`` m along is not on the beam."""
        length = self.length(mesh)
        rounding = 1e-9 * length
        if not -rounding <= at <= length + rounding:
            what = f"must be on the beam, which is {length:g} m long"
            raise InputError(what, key=key, value=value)

    def displacement_form(self, mesh: Mesh, at: float, dof: str) -> LinearForm:
        """Return a displacement or rotation along or about a global axis, ``at`` m along."""
        element, xi = self._locate(mesh, at)
        functions = THEORIES[self.theory].interpolation(
            xi, self._element_length(mesh), self.material, self.section
        )
        to_local = self._to_local(mesh)
        in_global = to_local[:6, :6].T @ functions @ to_local
        return LinearForm(self._element_dofs(mesh)[element], in_global[DOFS.index(dof)])

    def strain_form(self, mesh: Mesh, at: float, fibre: tuple[float, float]) -> LinearForm:
        """Return the axial strain of a fibre (y, z), ``at`` m along the beam."""
        element, xi = self._locate(mesh, at)
        strain = THEORIES[self.theory].axial_strain(
            xi, fibre, self._element_length(mesh), self.material, self.section
        )
        return LinearForm(self._element_dofs(mesh)[element], strain @ self._to_local(mesh))

    def position(self, mesh: Mesh, at: float) -> Vector:
        """Return the place ``at`` m along the beam, in m."""
        element, xi = self._locate(mesh, at)
        start, end = self._ends(mesh)
        x, y, z = start + (end - start) * ((element + xi) / self.elements)
        return float(x), float(y), float(z)

    def _ends(self, mesh: Mesh) -> tuple[FloatArray, FloatArray]:
        key = f"beams.{self.name}.nodes"
        first, last = (mesh.node(node, key) for node in self.nodes)
        return mesh.positions[first], mesh.positions[last]

    def _element_length(self, mesh: Mesh) -> float:
        return self.length(mesh) / self.elements

    def _element_dofs(self, mesh: Mesh) -> IndexArray:
        """Return the numbers of the dofs of each element, (elements, 12)."""
        names = (self.nodes[0], *self.inner_nodes, self.nodes[1])
        nodes = np.array([mesh.node(node) for node in names])
        dofs = mesh.dofs_of(nodes)
        return np.hstack([dofs[:-1], dofs[1:]])

    def _to_local(self, mesh: Mesh) -> FloatArray:
        """Return the matrix that turns an element's dofs from global to local axes, (12, 12)."""
        return np.kron(np.eye(4), local_axes(*self._ends(mesh))).astype(np.float64)

    def _locate(self, mesh: Mesh, at: float) -> tuple[int, float]:
        """Return the element ``at`` m along the beam, and how far along in it, 0 to 1."""
        place = min(max(at / self.length(mesh), 0.0), 1.0) * self.elements
        element = min(int(place), self.elements - 1)
        return element, place - element


def _turned(matrix: FloatArray, to_local: FloatArray) -> FloatArray:
    """Return a local matrix in global axes, exactly symmetric."""
    turned = to_local.T @ matrix @ to_local
    symmetric: FloatArray = 0.5 * (turned + turned.T)
    return symmetric


def _two_names(value: object) -> tuple[str, str]:
    if isinstance(value, str) or not isinstance(value, Sequence) or len(value) != 2:
        raise InputError("must be the names of two nodes", key="nodes", value=value)
    return name("nodes", value[0]), name("nodes", value[1])


def _element_count(value: object) -> int:
    number = count("elements", value)
    if number > MOST_ELEMENTS:
        raise InputError(f"must be {MOST_ELEMENTS} or fewer", key="elements", value=value)
    return number
