"""What the modes are computed from: a structure built here, or matrices from elsewhere."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, runtime_checkable

from bumpstop.arguments import FloatArray, Vector
from bumpstop.structure.dofs import Dof
from bumpstop.structure.forms import LinearForm
from bumpstop.structure.gauge import Gauge
from bumpstop.structure.sparse import IndexArray, SparseMatrix

if TYPE_CHECKING:
    from bumpstop.structure.beam_element import BeamElement

__all__ = [
    "BeamModel",
    "InertiaModel",
    "LinearModel",
    "RemarkingModel",
    "SectionModel",
    "StrainModel",
    "VibratingModel",
]


class VibratingModel(Protocol):
    """What modes alone are computed from.

    Matrices are on all dofs, supports and relations not yet applied. What can move is told by
    the independent dofs x, with u = ``expansion`` @ x on all dofs and x = u[``free``].
    """

    @property
    def free(self) -> IndexArray:
        """Numbers of the independent dofs, ascending."""

    @property
    def expansion(self) -> SparseMatrix:
        """All dofs by the independent ones, (dofs, free dofs)."""

    @property
    def stiffness(self) -> SparseMatrix:
        """Symmetric stiffness matrix; N/m, N and N m."""

    @property
    def mass(self) -> SparseMatrix:
        """Symmetric mass matrix; kg, kg m and kg m2."""

    def reduced(self, matrix: SparseMatrix) -> SparseMatrix:
        """Return expansion' @ matrix @ expansion; what is symmetric stays so to the bit."""

    def rigid_shapes(self) -> FloatArray:
        """Return all motions that strain nothing, by the independent dofs, (free dofs, r)."""


class LinearModel(VibratingModel, Protocol):
    """A linear model in space: all that a modal basis asks of a structure."""

    @property
    def dofs(self) -> tuple[Dof, ...]:
        """Node and dof of each row."""

    @property
    def damping(self) -> SparseMatrix:
        """Symmetric damping matrix; N s/m, N s and N m s."""

    @property
    def gyroscopic(self) -> SparseMatrix:
        """Skew-symmetric matrix of velocities; units as damping."""

    @property
    def circulatory(self) -> SparseMatrix:
        """Skew-symmetric matrix of displacements; units as stiffness."""

    def displacement_form(self, node: str, dof: str) -> LinearForm:
        """Return one dof of a node as a form of all dofs."""

    def position(self, node: str) -> Vector:
        """Return where a node is at rest, in m."""

    def rigid_field(
        self,
        *,
        translation: Vector = (0.0, 0.0, 0.0),
        rotation: Vector = (0.0, 0.0, 0.0),
        about: Vector = (0.0, 0.0, 0.0),
    ) -> FloatArray:
        """Return a small rigid motion of all dofs, those that are held too, (dofs,)."""


@runtime_checkable
class InertiaModel(Protocol):
    """What a model offers beside, if some of its motions may be without inertia."""

    def displacement_form(self, node: str, dof: str) -> LinearForm:
        """Return one dof of a node as a form of all dofs."""

    def has_inertia(self, form: LinearForm) -> bool:
        """Tell whether a force along a form accelerates masses alone."""


@runtime_checkable
class RemarkingModel(Protocol):
    """What a model offers beside, if there is something to be said of its parts."""

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a user should know, a line each."""


@runtime_checkable
class BeamModel(Protocol):
    """What a model offers beside, if its beams can be named."""

    def beam_nodes(self, beam: str) -> tuple[str, ...]:
        """Return the nodes of a beam, from end to end."""

    def beam_axes(self, beam: str) -> FloatArray:
        """Return the unit vectors of a beam's local axes, one a row, (3, 3)."""


@runtime_checkable
class StrainModel(Protocol):
    """What a model must offer beside, so that gauges can be read: it has beams."""

    def strain_form(self, gauge: Gauge) -> LinearForm:
        """Return a gauge's axial strain as a form of all dofs."""


@runtime_checkable
class SectionModel(Protocol):
    """What a model must offer beside, so that forces inside its beams can be read."""

    def section_forms(self, beam: str, at: float) -> tuple[LinearForm, ...]:
        """Return N, Vy, Vz, T, My and Mz of a section as forms of all dofs."""

    def beam_element(self, beam: str, at: float) -> BeamElement:
        """Return the element of a beam that a place is in, with its axes in the model."""

    def strain_form(self, gauge: Gauge) -> LinearForm:
        """Return the axial strain of a fibre as a form of all dofs."""

    def stress_form(self, gauge: Gauge) -> LinearForm:
        """Return the axial stress of a fibre as a form of all dofs."""
