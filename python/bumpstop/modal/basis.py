"""The modal basis: what the rest of the program knows of a structure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from bumpstop.arguments import FloatArray, did_you_mean, not_negative, one_of, series
from bumpstop.errors import InputError
from bumpstop.modal.certificate import SturmCount
from bumpstop.modal.damping import Damping, angular_frequencies
from bumpstop.modal.eigen import model_modes
from bumpstop.modal.given import given_components, given_labels, given_vectors, modal_masses
from bumpstop.modal.modal_damping import modal_damping, with_companions
from bumpstop.modal.projected import projected
from bumpstop.modal.remarks import feeding_told, rigid_told, unstable_told
from bumpstop.modal.rigid_modes import require_rigid_modes
from bumpstop.modal.selected import require_modes
from bumpstop.modal.selection import ModeSelection, mode_selection
from bumpstop.structure.dofs import DOFS, Dof, Place
from bumpstop.structure.free_motions import free_motions
from bumpstop.structure.gauge import Gauge
from bumpstop.structure.model import LinearModel, RemarkingModel, StrainModel
from bumpstop.structure.structure import Structure

# What a run from a structure's modes alone has no use for is imported where it is used.
if TYPE_CHECKING:
    from bumpstop.modal.companions import SpatialLoad
    from bumpstop.modal.coordinates import UserCoordinates
    from bumpstop.structure.sparse import SparseMatrix

__all__ = ["COMBINATION", "ModalBasis", "mode_labels"]

COMBINATION = "combination"
"""What a canonical vector is called that is made of several of the user's."""


@dataclass(frozen=True, eq=False)
class ModalBasis:
    """Vectors of unit modal mass, with their frequencies, damping and shapes.

    Make one with ``from_structure``, ``from_modes`` or ``from_vectors``. N is the number of
    vectors. Between them neither mass nor stiffness couples (the canonical form): they are
    modes of the structure, or of the structure forced to move as the vectors allow.

    Parameters
    ----------
    omega2
        Squared angular frequencies in rad2/s2, (N,); exactly zero for rigid modes, negative
        for those in which the structure is unstable.
    damping_ratio
        Ratios of critical damping, (N,).
    dofs
        Node and dof of each row of ``shapes``.
    shapes
        Mode shapes, (rows, N), in 1/sqrt(kg) and rad/(m sqrt(kg)).
    mass_rows
        Shapes times the mass matrix, (N, rows); None where there is no mass matrix.
    model
        What the modes were computed from; None for modes from elsewhere.
    damping_matrix
        The whole modal damping in rad/s, symmetric, (N, N); None where the ratios say it all.
    gyroscopic, circulatory
        What multiplies modal velocities and displacements beside damping and ``omega2``, skew,
        (N, N), in rad/s and rad2/s2; None where there is none.
    labels
        What each vector of the user is, in words: ``mode 1``, ``static shape of B dy``.
    coordinates
        How the user's vectors make the canonical ones; None where they are the same.
    dropped
        Which vectors were left out because they depend on others, a sentence each.
    neglected
        What else was left out on request, a sentence each.
    sturm
        The proof that no mode is missing; None where there is none.
    """

    omega2: FloatArray
    damping_ratio: FloatArray
    dofs: tuple[Dof, ...] = field(repr=False)
    shapes: FloatArray = field(repr=False)
    mass_rows: FloatArray | None = field(default=None, repr=False)
    model: LinearModel | None = field(default=None, repr=False)
    damping_matrix: FloatArray | None = field(default=None, repr=False)
    gyroscopic: FloatArray | None = field(default=None, repr=False)
    circulatory: FloatArray | None = field(default=None, repr=False)
    labels: tuple[str, ...] = field(default=(), repr=False)
    coordinates: UserCoordinates | None = field(default=None, repr=False)
    dropped: tuple[str, ...] = field(default=(), repr=False)
    neglected: tuple[str, ...] = field(default=(), repr=False)
    sturm: SturmCount | None = field(default=None, repr=False)

    unreduced: ClassVar[bool] = False
    """Whether the coordinates are dofs, between which mass and stiffness couple."""

    def __post_init__(self) -> None:
        if not self.labels:
            object.__setattr__(self, "labels", mode_labels(len(self.omega2)))

    @classmethod
    def from_structure(
        cls,
        structure: LinearModel,
        *,
        modes: int | str | ModeSelection,
        damping: Damping = 0.0,
        damping_coupling: str = "full",
        static_shapes: Sequence[Place] = (),
        constraint_shapes: Sequence[Place] = (),
        base_shapes: Sequence[str] = (),
        load_shapes: Sequence[SpatialLoad] = (),
        static_damping: float | None = None,
        rigid_modes: int | None = None,
    ) -> ModalBasis:
        """Compute modes of a structure, and static shapes as their companions.

        Parameters
        ----------
        structure
            The structure, with its supports.
        modes
            Number of modes, the lowest ones; ``ModesInBand``, ``ModesAround``; or ``"all"``,
            the complete basis.
        damping
            Ratio of critical damping: one for all modes, or one for each; or a rule such as
            ``RayleighDamping`` or ``StructuralDamping``. What dampers of the structure do to
            the modes is added.
        damping_coupling
            ``"full"``, or ``"diagonal"`` to neglect the damping that couples modes.
        static_shapes
            Where forces act that the modes left out would answer, such as those of stops: each
            a node and a dof, ``("B", "dy")``, or a node and a direction. The displacement under
            a unit force there, less what the modes have of it, joins the basis.
        constraint_shapes
            Places, as for ``static_shapes``: the displacement where one of them moves and the
            others are held, less what the modes have of it, joins the basis.
        base_shapes
            Directions ``dx dy dz drx dry drz``: the displacement under a steady acceleration
            of the base in each, less what the modes have of it, joins the basis.
        load_shapes
            Loads: the static displacement under each, less what the modes have of it, joins the
            basis, so that what the modes left out would give way to it is not lost.
        static_damping
            Ratio of critical damping of the static shapes, at the frequency that each has in
            the canonical form; that of the modes where left out.
        rigid_modes
            How many motions strain nothing, all of them, also beyond the modes asked for. Where
            left out, a structure in one piece may move as a whole; mechanisms, and pieces that
            move while nothing joins them to the others, are refused.

        Raises
        ------
        InputError
            If a value cannot be used, the structure has fewer free dofs than modes or no mode
            in the band, or a place is unknown or held; or if other motions strain nothing than
            ``rigid_modes`` says.
        """
        require_rigid_modes(structure, rigid_modes)
        selection = mode_selection(modes)
        omega2, shapes, sturm = model_modes(structure, selection)
        require_modes(len(omega2), selection)
        if not (static_shapes or constraint_shapes or base_shapes or load_shapes):
            ratios = with_companions(damping, static_damping, len(omega2), 0)
            plain = cls._from_shapes(structure, omega2, shapes, ratios, damping_coupling)
            return replace(plain, sturm=sturm)
        from bumpstop.modal.companions import companions

        beside = companions(
            structure,
            shapes,
            static_shapes=static_shapes,
            constraint_shapes=constraint_shapes,
            base_shapes=base_shapes,
            load_shapes=load_shapes,
        )
        number, more = len(omega2), len(beside.omega2)
        basis = cls._from_shapes(
            structure,
            np.concatenate([omega2, beside.omega2]),
            np.hstack([shapes, beside.shapes]),
            with_companions(damping, static_damping, number, more),
            damping_coupling,
        )
        coordinates = beside.coordinates
        return replace(
            basis,
            labels=(*mode_labels(number), *beside.labels),
            coordinates=None if coordinates is None else coordinates.after(number),
            dropped=beside.dropped,
            sturm=sturm,
        )

    @classmethod
    def from_vectors(
        cls,
        model: LinearModel,
        vectors: FloatArray,
        *,
        labels: Sequence[str] = (),
        damping: Damping = 0.0,
        damping_coupling: str = "full",
    ) -> ModalBasis:
        """Take any displacement fields of a model as the basis of its motion.

        The small eigenproblem of stiffness and mass on the vectors gives the canonical ones,
        of unit modal mass and without coupling. Rigid motions among the combinations of the
        vectors are separated exactly. Vectors that are in canonical form already are left as
        they are. A vector that depends on those before it is left out, and ``dropped`` says
        so. ``ModalState`` and the modal displacements of a response go on to count the vectors
        as they were given; ``coordinates`` holds the way from one to the other.

        Parameters
        ----------
        model
            The structure that the vectors belong to.
        vectors
            Displacements of all dofs of the model, one field a column, (dofs, U); any scale.
        labels
            What each vector is, in words, (U,); they are numbered where left out.
        damping
            As in ``from_structure``; a list has one ratio for each canonical vector, in the
            order of their frequencies.
        damping_coupling
            ``"full"``, or ``"diagonal"`` to neglect the damping that couples vectors.

        Raises
        ------
        InputError
            If a number is not finite, sizes do not fit, or a vector moves a dof that is held.

        Examples
        --------
        >>> from bumpstop import Material, PointMass, Structure, Support
        >>> point = Structure(nodes={"P": (0, 0, 0)}, masses=[PointMass("m", node="P", mass=4.0)],
        ...     supports=[Support(nodes="P", fixed=("dz", "drx", "dry", "drz"))])
        >>> basis = ModalBasis.from_vectors(point, np.eye(6)[:, :2])
        >>> basis.shapes[:2]
        array([[0.5, 0. ],
               [0. , 0.5]])
        """
        from bumpstop.modal.vectors import canonical_vectors

        given = given_vectors(model, vectors)
        names = given_labels(labels, given.shape[1])
        rigid = model.expansion @ model.rigid_shapes()
        found = canonical_vectors(given, model.stiffness, model.mass, rigid)
        if len(found.omega2) == 0:
            raise InputError("no vector moves any mass", key="vectors")
        basis = cls._from_shapes(model, found.omega2, found.shapes, damping, damping_coupling)
        return replace(
            basis,
            labels=names,
            coordinates=found.coordinates,
            dropped=tuple(f"{names[number]} {why}" for number, why in found.dropped.items()),
        )

    @classmethod
    def _from_shapes(
        cls,
        model: LinearModel,
        omega2: FloatArray,
        shapes: FloatArray,
        damping: Damping,
        damping_coupling: str,
    ) -> ModalBasis:
        """Return the basis of canonical shapes of a model, with all that the model adds."""
        dampers = projected(model.damping, shapes)
        ratio, matrix, neglected = modal_damping(damping, omega2, dampers, damping_coupling)
        return cls(
            omega2=omega2,
            damping_ratio=ratio,
            dofs=model.dofs,
            shapes=shapes,
            mass_rows=np.ascontiguousarray((model.mass @ shapes).T),
            model=model,
            damping_matrix=matrix,
            gyroscopic=projected(model.gyroscopic, shapes, skew=True),
            circulatory=projected(model.circulatory, shapes, skew=True),
            neglected=() if neglected is None else (neglected,),
        )

    @classmethod
    def from_modes(
        cls,
        *,
        frequency: Sequence[float],
        damping: Damping = 0.0,
        modal_mass: float | Sequence[float] = 1.0,
        shapes: Mapping[Dof, Sequence[float]],
    ) -> ModalBasis:
        """Take modes from elsewhere: a measurement, another program, a formula.

        Parameters
        ----------
        frequency
            Natural frequencies in Hz.
        damping
            Ratio of critical damping: one for all modes, or one for each; or a rule such as
            ``RayleighDamping``.
        modal_mass
            Modal mass in kg that belongs to the shapes: one for all modes, or one for each.
            Displacements of a ModalState go with the shapes as they are given.
        shapes
            Components of the modes by (node, dof), of any scale that ``modal_mass`` tells.

        Raises
        ------
        InputError
            If a value is not finite or negative, a dof is unknown, or numbers of modes differ.

        Examples
        --------
        >>> basis = ModalBasis.from_modes(
        ...     frequency=[3.0, 7.5], damping=[0.01, 0.01], shapes={("P", "dx"): [1.0, 0.4]}
        ... )
        >>> basis.row("P", "dx")
        array([1. , 0.4])
        """
        from bumpstop.modal.coordinates import scaled_coordinates

        hertz = [not_negative("frequency", value) for value in series("frequency", frequency)]
        rows = given_components(shapes, len(hertz))
        omega2 = (2.0 * np.pi * np.array(hertz)) ** 2
        ratio, matrix, _ = modal_damping(damping, omega2)
        scale = np.sqrt(modal_masses(modal_mass, len(hertz)))
        return cls(
            omega2=omega2,
            damping_ratio=ratio,
            damping_matrix=matrix,
            dofs=tuple((str(node), str(dof)) for node, dof in shapes),
            shapes=rows / scale,
            coordinates=scaled_coordinates(scale),
        )

    @property
    def structure(self) -> Structure | None:
        """The structure that the modes were computed from, if it was one."""
        return self.model if isinstance(self.model, Structure) else None

    @property
    def frequencies(self) -> FloatArray:
        """Natural frequencies in Hz, (N,).

        That of an unstable mode is negative: left alone, it
        grows e-fold in 1 / (2 pi f) seconds, f being its size.
        """
        frequencies: FloatArray = np.sign(self.omega2) * np.sqrt(np.abs(self.omega2))
        return frequencies / (2.0 * np.pi)

    @property
    def damping(self) -> FloatArray:
        """Damping of each modal equation alone, 2 xi omega, in rad/s, (N,)."""
        if self.damping_matrix is not None:
            return self.damping_matrix.diagonal().copy()
        return 2.0 * self.damping_ratio * angular_frequencies(self.omega2)

    @property
    def canonical_labels(self) -> tuple[str, ...]:
        """What each canonical vector is, (N,): one of the user's, or a combination of them."""
        if self.coordinates is None:
            return self.labels
        alone = self.coordinates.alone()
        return tuple(COMBINATION if of is None else self.labels[of] for of in alone)

    @property
    def whole_mass(self) -> SparseMatrix:
        """The masses of all dofs of its structure, those that supports hold too."""
        assert self.model is not None  # by the caller
        return self.model.mass

    @property
    def has_masses(self) -> bool:
        """Whether the mass of the whole model is known."""
        return self.model is not None and self.mass_rows is not None

    @property
    def couples(self) -> bool:
        """Whether damping, gyroscopic or circulatory forces couple the canonical vectors."""
        matrix = self.damping_matrix
        damped = matrix is not None and np.any(matrix - np.diag(matrix.diagonal()))
        return bool(damped or self.gyroscopic is not None or self.circulatory is not None)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a user should know of this basis, a line each: motions free of strain first."""
        model = self.model.remarks if isinstance(self.model, RemarkingModel) else ()
        return (
            *rigid_told(self.rigid_modes),
            *unstable_told(self.omega2),
            *feeding_told(self.damping_matrix),
            *model,
            *self.dropped,
            *self.neglected,
        )

    @cached_property
    def rigid_modes(self) -> tuple[str, ...]:
        """What the motions of the model are that strain nothing, a few words each.

        Also where the basis has fewer modes than there are such motions; nothing is known of
        modes from elsewhere.
        """
        if self.model is None:
            return ()
        return tuple(motion.text for motion in free_motions(self.model))

    def row(self, node: str, dof: str) -> FloatArray:
        """Return how much each mode moves a dof, (N,): u = row . q.

        Parameters
        ----------
        node
            Name of a node, of a mesh node (``"AB.3"``), or of a point along a beam
            (``"AB@0.462"``), which moves as its element's shape functions say.
        dof
            One of ``dx dy dz drx dry drz``.

        Raises
        ------
        InputError
            If the node or dof is unknown, or the basis has no shape for it.
        """
        if self.model is not None:
            return self.model.displacement_form(node, dof).of(self.shapes)
        number = self._rows.get((node, one_of("dof", dof, DOFS)))
        if number is not None:
            own: FloatArray = self.shapes[number].copy()
            return own
        nodes = dict.fromkeys(known for known, _ in self.dofs)
        if node not in nodes:
            hint = did_you_mean(node, nodes)
            raise InputError("no mode shape at this node", key="node", value=node, hint=hint)
        hint = f"known at {node!r}: " + ", ".join(d for known, d in self.dofs if known == node)
        raise InputError("no mode shape for this dof", key="dof", value=dof, hint=hint)

    def gauge_row(self, gauge: Gauge) -> FloatArray:
        """Return how much each mode strains a gauge, (N,): strain = gauge_row . q.

        Raises
        ------
        InputError
            If the gauge is not on a beam of the structure, or the basis has no structure.
        """
        if not isinstance(self.model, StrainModel):
            raise InputError("a gauge needs a basis computed from a structure", value=gauge.name)
        return self.model.strain_form(gauge).of(self.shapes)

    def project_field(self, field: FloatArray) -> FloatArray:
        """Return the modal coordinates nearest to a field in the norm of the mass matrix.

        Parameters
        ----------
        field
            One value for each of ``dofs``, (rows,).

        Raises
        ------
        InputError
            If the basis has no mass matrix.
        """
        if self.mass_rows is None:
            raise InputError(
                "this basis has no mass matrix to project a field with",
                hint="give the initial state mode by mode, as a ModalState",
            )
        coordinates: FloatArray = self.mass_rows @ field
        return coordinates

    def require_modes(self, key: str) -> None:
        """Raise where mass or stiffness couples the coordinates, as in a full model.

        Raises
        ------
        InputError
            If they do; ``key`` says what needs modes.
        """
        if self.unreduced:
            what = "needs modes, which a full model has not"
            raise InputError(what, key=key, hint="take a ModalBasis, of all modes if you like")

    def canonical(self, amplitudes: FloatArray) -> FloatArray:
        """Return the canonical coordinates (N,) of amplitudes of the user's vectors (U,)."""
        return (
            amplitudes if self.coordinates is None else self.coordinates.to_canonical @ amplitudes
        )

    def amplitudes(self, motion: FloatArray) -> FloatArray:
        """Return the amplitudes of the user's vectors, (..., U), in a canonical motion (..., N)."""
        if self.coordinates is None:
            return motion
        # Not BLAS: an instant must have the same bits on any grid.
        given: FloatArray = np.einsum("...n,un->...u", motion, self.coordinates.from_canonical)
        return given

    @cached_property
    def _rows(self) -> dict[Dof, int]:
        return {dof: number for number, dof in enumerate(self.dofs)}


def mode_labels(count: int) -> tuple[str, ...]:
    """Return what modes are called: ``mode 1`` and so on."""
    return tuple(f"mode {number}" for number in range(1, count + 1))
