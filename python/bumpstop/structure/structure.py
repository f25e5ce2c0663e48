"""The structure: parts on named nodes, and the matrices they add up to."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from bumpstop import structure
from bumpstop.arguments import FloatArray, Vector, did_you_mean, one_of
from bumpstop.errors import InputError, blamed
from bumpstop.structure.assembly import KINDS, Assembler, Part
from bumpstop.structure.beam import Beam
from bumpstop.structure.beam_blocks import beam_blocks
from bumpstop.structure.dofs import DOFS, Dof
from bumpstop.structure.drawn import Line
from bumpstop.structure.elimination import Freedom, freedom
from bumpstop.structure.forms import LinearForm
from bumpstop.structure.frame import rigid_field
from bumpstop.structure.massless import surely_massive
from bumpstop.structure.mesh import Mesh, user_nodes
from bumpstop.structure.mobility import Mobility, mobility
from bumpstop.structure.points import beam_point
from bumpstop.structure.rigid import rigid_fields
from bumpstop.structure.sparse import IndexArray, SparseMatrix

if TYPE_CHECKING:
    from bumpstop.structure.beam_element import BeamElement
    from bumpstop.structure.bearing import Bearing
    from bumpstop.structure.gauge import Gauge
    from bumpstop.structure.link import RigidLink
    from bumpstop.structure.mass import PointMass
    from bumpstop.structure.relation import Relation
    from bumpstop.structure.spring import Spring
    from bumpstop.structure.support import Support

__all__ = ["Structure"]

_KINDS = {
    "beams": "Beam",
    "masses": "PointMass",
    "springs": "Spring",
    "bearings": "Bearing",
    "supports": "Support",
    "relations": "Relation",
    "links": "RigidLink",
}
"""Classes of the parts: names of the package, which loads a class with its first part."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Structure:
    """A linear structure in space.

    Matrices and fields have six rows a mesh node, those of supports included: ``dofs`` names
    them, ``free`` numbers those that can move. The structure moves as
    M u'' + (C + G) u' + (K + N) u = f, with the matrices ``mass``, ``damping``,
    ``gyroscopic``, ``stiffness`` and ``circulatory``.

    Parameters
    ----------
    nodes
        Coordinates (x, y, z) of each named node, in m.
    beams, masses, springs, bearings
        What stands between and on the nodes. Rotations of a node that nothing resists and
        that carry no inertia, as where bars meet, are no dofs of the structure.
    supports
        Which dofs are held at zero.
    relations
        Weighted sums of dofs that stay zero.
    links
        Nodes that rigid bodies join.

    Raises
    ------
    InputError
        If a name is unknown or used twice, a beam has no length, or a node that can move is
        attached to nothing or has no mass.

    Examples
    --------
    >>> from bumpstop import Beam, Material, Rectangle, Structure, Support
    >>> steel = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
    >>> bar = Rectangle(height=0.02, width=0.02)
    >>> cantilever = Structure(
    ...     nodes={"A": (0, 0, 0), "B": (1, 0, 0)},
    ...     beams=[Beam("AB", nodes=("A", "B"), elements=4, material=steel, section=bar)],
    ...     supports=[Support(nodes="A", fixed=("dx", "dy", "dz", "drx", "dry", "drz"))],
    ... )
    >>> cantilever.stiffness.shape, len(cantilever.free)
    ((30, 30), 24)
    """

    nodes: Mapping[str, Sequence[float]]
    beams: Sequence[Beam] = ()
    masses: Sequence[PointMass] = ()
    springs: Sequence[Spring] = ()
    bearings: Sequence[Bearing] = ()
    supports: Sequence[Support] = ()
    relations: Sequence[Relation] = ()
    links: Sequence[RigidLink] = ()

    def __post_init__(self) -> None:
        for kind, wanted in _KINDS.items():
            object.__setattr__(self, kind, _all_of(kind, wanted, getattr(self, kind)))
        for kind in ("beams", "masses", "springs", "bearings", "links"):
            _refuse_twins(kind, [part.name for part in getattr(self, kind)])
        _refuse_twins("nodes", self.mesh.names)
        self._refuse_loose_nodes()
        self._mobility  # noqa: B018  # says what is wrong now, not when modes are asked for

    @cached_property
    def mesh(self) -> Mesh:
        """The nodes that the user gave, and then those inside the beams."""
        mesh = user_nodes(self.nodes)
        meshed = [beam for beam in self.beams if beam.elements > 1]
        names = [node for beam in meshed for node in beam.inner_nodes]
        return mesh.with_nodes(names, [beam.inner_positions(mesh) for beam in meshed])

    @property
    def lines(self) -> list[Line]:
        """The beams, as they are drawn."""
        return [Line(beam.name, beam.length(self.mesh), beam.elements) for beam in self.beams]

    @property
    def dofs(self) -> tuple[Dof, ...]:
        """Node and dof of each row."""
        return self.mesh.dofs

    @property
    def free(self) -> IndexArray:
        """Numbers of the independent dofs, ascending: not held, nor told by other dofs."""
        return self._freedom.free

    @property
    def expansion(self) -> SparseMatrix:
        """All dofs by the free ones, (dofs, free dofs): u = expansion @ x, with x = u[free]."""
        return self._freedom.expansion

    @cached_property
    def stiffness(self) -> SparseMatrix:
        """Symmetric stiffness matrix on all dofs, supports not yet applied; N/m, N and N m."""
        return self._assembly.matrix("stiffness")

    @cached_property
    def mass(self) -> SparseMatrix:
        """Symmetric mass matrix on all dofs, supports not yet applied; kg, kg m and kg m2."""
        return self._assembly.matrix("mass")

    @cached_property
    def damping(self) -> SparseMatrix:
        """Symmetric damping matrix of the parts, on all dofs; N s/m, N s and N m s."""
        return self._assembly.matrix("damping")

    @cached_property
    def gyroscopic(self) -> SparseMatrix:
        """Skew-symmetric gyroscopic matrix of the parts that spin, on all dofs; as damping."""
        return self._assembly.matrix("gyroscopic")

    @cached_property
    def circulatory(self) -> SparseMatrix:
        """Skew-symmetric part of the stiffness of bearings, on all dofs; as stiffness."""
        return self._assembly.matrix("circulatory")

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a user should know of its parts, a line each."""
        told = [mass.remarks for mass in self.masses] + [spring.remarks for spring in self.springs]
        return tuple(remark for remarks in told for remark in remarks)

    def reduced(self, matrix: SparseMatrix) -> SparseMatrix:
        """Return a matrix of all dofs as one of the free dofs, expansion' @ matrix @ expansion."""
        return self._freedom.reduced(matrix)

    def rigid_shapes(self) -> FloatArray:
        """Return all motions that strain nothing, by the free dofs, (free dofs, motions)."""
        return self._rigid_fields[self.free]

    def has_inertia(self, form: LinearForm) -> bool:
        """Tell whether a force along a form accelerates masses alone.

        A force on a dof without mass would move it at once, which no mode can follow.
        """
        return self._mobility.has_inertia(form)

    def displacement_form(self, node: str, dof: str) -> LinearForm:
        """Return one dof of a node, or of a point along a beam, as a form of all dofs.

        Raises
        ------
        InputError
            If the node, the beam or the dof is unknown, or the point is not on the beam.
        """
        one_of("dof", dof, DOFS)
        point = self._beam_point(node)
        if point is not None:
            beam, at = point
            return beam.displacement_form(self.mesh, at, dof)
        number = 6 * self.mesh.node(node) + DOFS.index(dof)
        return LinearForm(np.array([number]), np.ones(1))

    def strain_form(self, gauge: Gauge) -> LinearForm:
        """Return a gauge's axial strain as a form of all dofs.

        Raises
        ------
        InputError
            If the beam is unknown, or the gauge is not on it.
        """
        beam = self._beam(gauge.beam, "beam")
        beam.require_on(self.mesh, gauge.at, key="at", value=gauge.at)
        section = beam.section_at(gauge.at / beam.length(self.mesh))
        if not section.contains(*gauge.fibre):
            hint = "y and z are measured from the centroid"
            raise InputError("is outside the section", key="fibre", value=gauge.fibre, hint=hint)
        return beam.strain_form(self.mesh, gauge.at, gauge.fibre)

    def section_forms(self, beam: str, at: float) -> tuple[LinearForm, ...]:
        """Return the forces in a beam's section as forms of all dofs: N, Vy, Vz, T, My, Mz.

        They are those of the part beyond the section, ``at`` m from the beam's first node, on
        the part before it, along and about local axes, in N and N m.

        Raises
        ------
        InputError
            If the beam is unknown, or the section is not on it.
        """
        found = self._beam(beam, "beam")
        found.require_on(self.mesh, at, key="at", value=at)
        return found.section_forms(self.mesh, at)

    def beam_element(self, beam: str, at: float) -> BeamElement:
        """Return the element of a beam ``at`` m from its first node.

        Raises
        ------
        InputError
            If the beam is unknown, or the place is not on it.
        """
        found = self._beam(beam, "beam")
        found.require_on(self.mesh, at, key="at", value=at)
        return found.element_at(self.mesh, at)

    def stress_form(self, gauge: Gauge) -> LinearForm:
        """Return the axial stress of a fibre, in Pa, as a form of all dofs.

        Raises
        ------
        InputError
            As `strain_form` does.
        """
        strain = self.strain_form(gauge)
        young = self._beam(gauge.beam, "beam").material.young_modulus
        return LinearForm(strain.dofs, young * strain.weights)

    def beam_nodes(self, beam: str) -> tuple[str, ...]:
        """Return the nodes of a beam, from end to end.

        Raises
        ------
        InputError
            If the beam is unknown.
        """
        found = self._beam(beam, "beams")
        return (found.nodes[0], *found.inner_nodes, found.nodes[1])

    def beam_axes(self, beam: str) -> FloatArray:
        """Return the unit vectors of a beam's local axes x, y, z, one a row, (3, 3).

        Raises
        ------
        InputError
            If the beam is unknown.
        """
        return self._beam(beam, "beams").axes(self.mesh)

    def position(self, node: str) -> Vector:
        """Return where a node, or a point along a beam, is at rest, in m.

        Raises
        ------
        InputError
            If the node or the beam is unknown, or the point is not on the beam.
        """
        point = self._beam_point(node)
        if point is not None:
            beam, at = point
            return beam.position(self.mesh, at)
        x, y, z = self.mesh.positions[self.mesh.node(node)]
        return float(x), float(y), float(z)

    def rigid_field(
        self,
        *,
        translation: Vector = (0.0, 0.0, 0.0),
        rotation: Vector = (0.0, 0.0, 0.0),
        about: Vector = (0.0, 0.0, 0.0),
    ) -> FloatArray:
        """Return a small rigid motion of the whole structure, one value a dof.

        Parameters
        ----------
        translation
            Along the global axes, in m; or in m/s for a velocity, m/s2 for gravity.
        rotation
            About the global axes, in rad (rad/s, rad/s2).
        about
            Where the axes of rotation meet, in m.
        """
        places = self.mesh.positions
        return rigid_field(places, translation=translation, rotation=rotation, about=about)

    @cached_property
    def _rigid_fields(self) -> FloatArray:
        return rigid_fields(self.mesh, self._assembly.parts, self._mobility.allowed)

    @property
    def _freedom(self) -> Freedom:
        return self._mobility.freedom

    @cached_property
    def _mobility(self) -> Mobility:
        massive = surely_massive(self.mesh, self._assembly.parts)
        matrices = {kind: getattr(self, kind) for kind in KINDS}
        return mobility(self.dofs, self._told, self._scale, massive, matrices)

    @cached_property
    def _told(self) -> Freedom:
        """What supports, relations and links allow."""
        held = np.zeros(len(self.dofs), dtype=bool)
        for number, support in enumerate(self.supports):
            held[support.held(self.mesh, f"supports[{number}]")] = True
        return freedom(held, self._zeros, self._scale)

    @cached_property
    def _scale(self) -> FloatArray:
        """Size of a typical motion of each dof: it moves something by about 1 m."""
        scale = np.ones(len(self.dofs))
        scale.reshape(-1, 6)[:, 3:] = 1.0 / self.mesh.size
        return scale

    @cached_property
    def _zeros(self) -> list[LinearForm]:
        """Sums of dofs that relations and links let be zero."""
        zeros = []
        for number, relation in enumerate(self.relations):
            with blamed(f"relations[{number}].terms"):
                zeros.append(relation.form(self.displacement_form))
        for link in self.links:
            with blamed(f"links.{link.name}.nodes"):
                zeros.extend(link.forms(self.position, self.displacement_form))
        return zeros

    @cached_property
    def _assembly(self) -> Assembler:
        parts: list[Part] = [*self.masses, *self.springs, *self.bearings]
        blocks = [part.block(self.mesh) for part in parts]
        return Assembler([*beam_blocks(self.beams, self.mesh), *blocks], len(self.mesh.names))

    def _beam_point(self, node: str) -> tuple[Beam, float] | None:
        """Return the beam and the distance along it that a point's name tells."""
        point = beam_point(node)
        if point is None:
            return None
        beam = self._beam(point[0], "node")
        beam.require_on(self.mesh, point[1], key="node", value=node)
        return beam, point[1]

    def _beam(self, name: str, key: str) -> Beam:
        for beam in self.beams:
            if beam.name == name:
                return beam
        hint = did_you_mean(name, [beam.name for beam in self.beams])
        raise InputError("unknown beam", key=key, value=name, hint=hint)

    def _refuse_loose_nodes(self) -> None:
        """Raise where a node can move that no part is attached to."""
        attached = np.zeros(len(self.mesh.names), dtype=bool)
        for block in self._assembly.parts:
            attached[block.nodes] = True
        for zero in self._zeros:
            attached[zero.dofs // 6] = True
        moving = self._told.free // 6
        loose = moving[~attached[moving]]
        if len(loose):
            node = self.mesh.names[loose[0]]
            hint = "put a beam or a mass on it, or fix all its dofs"
            raise InputError("the node is attached to nothing", key=f"nodes.{node}", hint=hint)


def _all_of(key: str, wanted: str, value: object) -> tuple[object, ...]:
    if isinstance(value, str | Mapping) or not isinstance(value, Iterable):
        raise InputError(f"must be a list of {wanted}s", key=key, value=value)
    listed = tuple(value)
    for item in listed:
        if not isinstance(item, getattr(structure, wanted)):
            raise InputError(f"must hold {wanted}s only", key=key, value=item)
    return listed


def _refuse_twins(key: str, names: Iterable[str]) -> None:
    seen: set[str] = set()
    for name in names:
        if name in seen:
            raise InputError("this name is used twice", key=key, value=name)
        seen.add(name)
