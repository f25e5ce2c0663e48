"""Straight beams of equal elements."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

import numpy as np

from bumpstop.arguments import FloatArray, Vector, count, finite, name, not_negative, one_of
from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.elements import THEORIES, Element, Slice
from bumpstop.structure.forms import LinearForm
from bumpstop.structure.frame import local_axes
from bumpstop.structure.material import Material
from bumpstop.structure.mesh import Mesh
from bumpstop.structure.sections.section import Section
from bumpstop.structure.sparse import IndexArray

if TYPE_CHECKING:
    from bumpstop.structure.beam_element import BeamElement
    from bumpstop.structure.elements.varying import VaryingElement

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
    global Z, local y is the global Y. ``roll`` then turns y and z about x.

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
        Its cross section, for instance a ``Rectangle``; at the first node, if it varies.
    end_section
        The section at the last node, of the same shape; in between, every dimension changes
        linearly. Stiffness is still exact for loads at the nodes.
    theory
        ``"timoshenko"``: bending with shear strain and rotary inertia; ``"rayleigh"``: without
        shear strain; ``"euler_bernoulli"``: with neither; ``"bar"``: stretch alone.
    roll
        Angle in rad by which local y and z are turned about local x.
    mass
        ``"consistent"``: by the element's own functions; ``"lumped"``: a diagonal matrix.
    added_mass
        Mass in kg/m that moves with the beam in every direction: contents, insulation.
    tension
        Axial force in N, constant along the beam and in time; negative for a compression. It
        stiffens bending and twist.
    spin
        Speed in rad/s at which the beam turns about local x, constant in time: its sections'
        angular momentum makes the gyroscopic matrix.

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
    end_section: Section | None = field(default=None, kw_only=True)
    roll: float = field(default=0.0, kw_only=True)
    mass: str = field(default="consistent", kw_only=True)
    added_mass: float = field(default=0.0, kw_only=True)
    tension: float = field(default=0.0, kw_only=True)
    spin: float = field(default=0.0, kw_only=True)

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", name("name", self.name))
        object.__setattr__(self, "nodes", _two_names(self.nodes))
        object.__setattr__(self, "elements", _element_count(self.elements))
        one_of("theory", self.theory, tuple(THEORIES))
        one_of("mass", self.mass, ("consistent", "lumped"))
        if not isinstance(self.material, Material):
            raise InputError("must be a Material", key="material", value=self.material)
        if not isinstance(self.section, Section):
            raise InputError("must be a section", key="section", value=self.section)
        if self.end_section is not None:
            self._require_taper(self.end_section)
        object.__setattr__(self, "added_mass", not_negative("added_mass", self.added_mass))
        for key in ("roll", "tension", "spin"):
            object.__setattr__(self, key, finite(key, getattr(self, key)))
        if self.spin != 0.0:
            self._require_shaft()

    @cached_property
    def inner_nodes(self) -> tuple[str, ...]:
        """Names of the mesh nodes inside the beam."""
        return tuple(f"{self.name}.{number}" for number in range(1, self.elements))

    def inner_positions(self, mesh: Mesh) -> FloatArray:
        """Return the places of the mesh nodes inside the beam, (elements - 1, 3)."""
        start, end = self._ends(mesh)
        part = np.arange(1, self.elements)[:, np.newaxis] / self.elements
        positions: FloatArray = start + (end - start) * part
        return positions

    @property
    def varies(self) -> bool:
        """Whether it takes the element of varying section: tapered, or bent and twisted at once."""
        bends = THEORIES[self.theory].bends
        return bends and (self.end_section is not None or any(self.section.shear_center))

    def section_at(self, part: float) -> Section:
        """Return the section at a part of the length, from 0 to 1."""
        if self.end_section is None:
            return self.section
        return self.section.between(self.end_section, part)

    def slice_at(self, part: float) -> Slice:
        """Return what a slice at a part of the length, from 0 to 1, resists and weighs."""
        return THEORIES[self.theory].slice_of(self.material, self.section_at(part), self.added_mass)

    def varying_element(self, mesh: Mesh, element: int) -> VaryingElement:
        """Return one of its elements, counted from 0, as one of varying section."""
        from bumpstop.structure.elements.varying import VaryingElement

        return VaryingElement(
            self._element_length(mesh),
            lru_cache(None)(lambda xi: self.slice_at((element + xi) / self.elements)),
        )

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
            raise self.without_length()
        return length

    def without_length(self) -> InputError:
        """Return the error that says that the beam has no length."""
        return InputError(
            "the beam has no length",
            key=f"beams.{self.name}.nodes",
            value=self.nodes,
            hint="its two nodes must be at different places",
        )

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
        if self.varies:
            functions = self.varying_element(mesh, element).interpolation(xi)
        else:
            length = self._element_length(mesh)
            functions = self._element.interpolation(xi, length, self.slice_at(0.0))
        to_local = self._to_local(mesh)
        in_global = to_local[:6, :6].T @ functions @ to_local
        return LinearForm(self._element_dofs(mesh)[element], in_global[DOFS.index(dof)])

    def strain_form(self, mesh: Mesh, at: float, fibre: tuple[float, float]) -> LinearForm:
        """Return the axial strain of a fibre (y, z), ``at`` m along the beam."""
        element, xi = self._locate(mesh, at)
        if self.varies:
            strain = self.varying_element(mesh, element).axial_strain(xi, fibre)
        else:
            length = self._element_length(mesh)
            strain = self._element.axial_strain(xi, fibre, length, self.slice_at(0.0))
        return LinearForm(self._element_dofs(mesh)[element], strain @ self._to_local(mesh))

    def axes(self, mesh: Mesh) -> FloatArray:
        """Return the unit vectors of its local axes, one a row, (3, 3)."""
        return local_axes(*self._ends(mesh), self.roll)

    def section_forms(self, mesh: Mesh, at: float) -> tuple[LinearForm, ...]:
        """Return the six forces in the section ``at`` m along: N, Vy, Vz, T, My, Mz.

        They are the element's stiffness times the displacements of its nodes, carried to the
        section: what the part beyond it does to the part before it, along and about local axes.
        """
        element, xi = self._locate(mesh, at)
        if self.varies:
            forces = self.varying_element(mesh, element).section_forces(xi)
        else:
            from bumpstop.structure.elements.varying import section_forces

            length, part = self._element_length(mesh), self.slice_at(0.0)
            at_end = self._element.stiffness(length, part)[6:]
            forces = section_forces(part, (1.0 - xi) * length) @ at_end
        dofs = self._element_dofs(mesh)[element]
        return tuple(LinearForm(dofs, row) for row in forces @ self._to_local(mesh))

    def element_at(self, mesh: Mesh, at: float) -> BeamElement:
        """Return the element ``at`` m along, as forces between its nodes see it."""
        from bumpstop.structure.beam_element import BeamElement

        element, _ = self._locate(mesh, at)
        length = self._element_length(mesh)
        varying = self.varying_element(mesh, element) if self.varies else None
        part = self.slice_at(0.0)

        def interpolation(xi: float) -> FloatArray:
            if varying is None:
                return self._element.interpolation(xi, length, part)
            return varying.interpolation(xi)

        return BeamElement(
            start=element * length,
            length=length,
            axes=self.axes(mesh),
            slice_at=lru_cache(None)(lambda xi: self.slice_at((element + xi) / self.elements)),
            interpolation=interpolation,
            is_lumped=self.mass == "lumped",
            bends=THEORIES[self.theory].bends,
            spin=self.spin,
        )

    def position(self, mesh: Mesh, at: float) -> Vector:
        """Return the place ``at`` m along the beam, in m."""
        element, xi = self._locate(mesh, at)
        start, end = self._ends(mesh)
        x, y, z = start + (end - start) * ((element + xi) / self.elements)
        return float(x), float(y), float(z)

    def _require_shaft(self) -> None:
        """Raise where the gyroscopic matrix of a constant speed has no meaning."""
        if not THEORIES[self.theory].rotary:
            hint = 'take theory "timoshenko" or "rayleigh"'
            raise InputError(
                "a beam that spins needs rotary inertia", key="theory", value=self.theory, hint=hint
            )
        for section in (self.section, self.end_section or self.section):
            factor_y, factor_z = section.shear_factors
            as_stiff = math.isclose(section.inertia_y, section.inertia_z, rel_tol=1e-9)
            if not as_stiff or factor_y != factor_z or any(section.shear_center):
                what = "a beam that spins must be as stiff about y as about z"
                raise InputError(what, key="spin", value=self.spin, hint="take a circle or a tube")

    def _require_taper(self, end_section: object) -> None:
        if not isinstance(end_section, Section):
            raise InputError("must be a section", key="end_section", value=end_section)
        if not THEORIES[self.theory].bends:
            what, hint = "a bar has the same section everywhere", "leave end_section out"
            raise InputError(what, key="end_section", hint=hint)
        self.section.between(end_section, 0.5)

    @property
    def _element(self) -> Element:
        return THEORIES[self.theory].element

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
        return np.kron(np.eye(4), self.axes(mesh)).astype(np.float64)

    def _locate(self, mesh: Mesh, at: float) -> tuple[int, float]:
        """Return the element ``at`` m along the beam, and how far along in it, 0 to 1."""
        place = min(max(at / self.length(mesh), 0.0), 1.0) * self.elements
        element = min(int(place), self.elements - 1)
        return element, place - element


def _two_names(value: object) -> tuple[str, str]:
    if isinstance(value, str) or not isinstance(value, Sequence) or len(value) != 2:
        raise InputError("must be the names of two nodes", key="nodes", value=value)
    return name("nodes", value[0]), name("nodes", value[1])


def _element_count(value: object) -> int:
    number = count("elements", value)
    if number > MOST_ELEMENTS:
        raise InputError(f"must be {MOST_ELEMENTS} or fewer", key="elements", value=value)
    return number
