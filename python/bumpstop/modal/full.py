"""FullModel: a structure on its own dofs, not reduced to modes."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

import numpy as np

from bumpstop.arguments import FloatArray, one_of
from bumpstop.errors import InputError
from bumpstop.modal.basis import ModalBasis
from bumpstop.modal.damping import Damping, RayleighDamping
from bumpstop.modal.modal_damping import modal_damping
from bumpstop.modal.rigid_modes import require_rigid_modes
from bumpstop.structure.lumped import lumped_mass
from bumpstop.structure.sparse import IndexArray, SparseMatrix

if TYPE_CHECKING:
    from bumpstop.structure.model import LinearModel

__all__ = ["FullMatrices", "FullModel", "numbers_of"]

MASSES = ("consistent", "lumped")
MOST_DENSE = 2_000_000
"""Entries up to which what belongs to each dof is kept as a plain array."""
MOST_DAMPED = 1500
"""Free dofs up to which ratios of damping can be had: they couple all dofs."""


class FullMatrices(NamedTuple):
    """What multiplies accelerations, velocities and displacements of the independent dofs."""

    mass: SparseMatrix
    damping: SparseMatrix
    stiffness: SparseMatrix


@dataclass(frozen=True, eq=False)
class FullModel(ModalBasis):
    """A structure as it is: its coordinates are the independent dofs themselves.

    It stands where a basis stands. What is a mode of a basis is a dof that moves by one here;
    between the dofs mass, damping and stiffness couple, and no coordinate has a frequency. Only
    methods that step through time take it: ``newmark``, ``hht`` and ``generalized_alpha``, which
    solve with one factored matrix, and, with lumped masses, ``central_difference``, which is
    explicit. Make one with ``from_structure``.

    Parameters
    ----------
    matrices
        Mass, damping and stiffness of the independent dofs.
    lumped
        Whether the masses are lumped.
    """

    matrices: FullMatrices = field(kw_only=True, repr=False)
    lumped: bool = field(default=False, kw_only=True)

    unreduced: ClassVar[bool] = True

    @classmethod
    def from_structure(  # type: ignore[override]  # nothing is selected
        cls,
        structure: LinearModel,
        *,
        damping: Damping = 0.0,
        mass: str = "consistent",
        rigid_modes: int | None = None,
    ) -> Self:
        """Take a structure on its dofs.

        Parameters
        ----------
        structure
            The structure, with its supports.
        damping
            ``RayleighDamping``, which is as sparse as mass and stiffness; or, for structures of
            up to 1500 dofs, what a basis of all modes would take: its matrix couples all dofs.
            Dampers of the structure are added.
        mass
            ``"consistent"``, or ``"lumped"`` for a diagonal mass matrix.
        rigid_modes
            As in ``ModalBasis.from_structure``.

        Raises
        ------
        InputError
            If a value cannot be used, or a part of the structure has gyroscopic or circulatory
            forces.

        Examples
        --------
        >>> from bumpstop import Material, PointMass, Structure, Support
        >>> point = Structure(nodes={"P": (0, 0, 0)}, masses=[PointMass("m", node="P", mass=4.0)],
        ...     supports=[Support(nodes="P", fixed=("dy", "dz", "drx", "dry", "drz"))])
        >>> model = FullModel.from_structure(point)
        >>> model.labels, model.matrices.mass.to_dense().tolist()
        (('P dx',), [[4.0]])
        """
        one_of("mass", mass, MASSES)
        require_rigid_modes(structure, rigid_modes)
        for name in ("gyroscopic", "circulatory"):
            if getattr(structure, name).values.any():
                what = f"has {name} forces, which a full model does not take"
                raise InputError(what, key="structure", hint="take a modal basis")
        masses = lumped_mass(structure) if mass == "lumped" else structure.mass
        own, stiffness = structure.reduced(masses), structure.reduced(structure.stiffness)
        matrices = FullMatrices(own, _damping(structure, damping, own, stiffness), stiffness)
        shapes = structure.expansion
        moved = masses.times(shapes).transposed()
        unknown = np.full(shapes.shape[1], np.nan)
        return cls(
            omega2=unknown,
            damping_ratio=unknown,
            dofs=structure.dofs,
            shapes=numbers_of(shapes),
            mass_rows=numbers_of(moved),
            model=structure,
            labels=tuple(" ".join(structure.dofs[dof]) for dof in structure.free),
            matrices=matrices,
            lumped=mass == "lumped",
        )

    @property
    def whole_mass(self) -> SparseMatrix:
        """The masses of all dofs, those that supports hold too."""
        assert self.model is not None  # made from one
        return lumped_mass(self.model) if self.lumped else self.model.mass

    def project_field(self, field: FloatArray) -> FloatArray:
        """Return the independent dofs of a field, (N,), given for each of ``dofs``."""
        assert self.model is not None  # made from one
        return field[self.model.free]

    def only(self, kept: IndexArray) -> FullModel:
        """Return what some of the coordinates tell, for reading: its matrices are those of all."""
        assert self.mass_rows is not None  # made with them
        return replace(
            self,
            omega2=self.omega2[kept],
            damping_ratio=self.damping_ratio[kept],
            shapes=self.shapes[:, kept],
            mass_rows=self.mass_rows[kept],
            labels=tuple(self.labels[number] for number in kept),
        )


def numbers_of(matrix: SparseMatrix) -> FloatArray:
    """Return a matrix as an array; as SciPy's sparse one, which is read alike, if it is large."""
    if matrix.shape[0] * matrix.shape[1] <= MOST_DENSE:
        return matrix.to_dense()
    sparse: Any = matrix.to_scipy().tocsr()
    array: FloatArray = sparse
    return array


def _damping(
    structure: LinearModel, damping: Damping, mass: SparseMatrix, stiffness: SparseMatrix
) -> SparseMatrix:
    dampers = structure.reduced(structure.damping)
    if isinstance(damping, RayleighDamping):
        return dampers.plus(mass.scaled(damping.alpha)).plus(stiffness.scaled(damping.beta))
    if damping == 0.0:
        return dampers
    size = mass.shape[0]
    if size > MOST_DAMPED:
        what = f"couples all {size} dofs, for each mode has its own ratio"
        raise InputError(what, key="damping", hint="give RayleighDamping")
    from scipy.linalg import eigh

    omega2, shapes = eigh(stiffness.to_dense(), mass.to_dense())
    # Rigid modes are zero to rounding, which no ratio is to be taken of.
    omega2[omega2 < 1e-12 * omega2[-1]] = 0.0
    ratio, matrix, _ = modal_damping(damping, omega2)
    own = 2.0 * ratio * np.sqrt(omega2) if matrix is None else matrix.diagonal()
    moved = mass @ shapes
    whole = (moved * own) @ moved.T
    rows, columns = np.indices(whole.shape)
    symmetric = 0.5 * (whole + whole.T)
    places = rows.T.ravel(), columns.T.ravel()
    return dampers.plus(SparseMatrix.from_triplets(mass.shape, *places, symmetric.ravel()))
