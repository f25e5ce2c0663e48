"""Complex modes: what damping, spin and skew stiffness make of the modes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray
from bumpstop.modal.turned import turned_fields, unit_axis
from bumpstop.structure.dofs import Dof

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bumpstop.modal.basis import ModalBasis
    from bumpstop.structure.sparse import SparseMatrix

__all__ = ["ComplexModes", "complex_modes"]

ComplexArray: TypeAlias = NDArray[np.complex128]

NEGLIGIBLE = 1e-12
"""Eigenvalues below this, relative to the largest, are zero."""


@dataclass(frozen=True, eq=False)
class ComplexModes:
    """Free motions ``u = Re(shape exp(eigenvalue t))`` of a structure.

    An oscillation has two conjugate eigenvalues and is counted once; what only decays or grows
    has a real one. They come by rising frequency, real ones first.

    Parameters
    ----------
    eigenvalues
        In rad/s, (n,), imaginary part positive or zero.
    vectors
        Canonical coordinates of each, (N, n), of length one.
    shapes
        Displacements of the dofs, (rows, n).
    dofs
        Node and dof of each row of ``shapes``.
    mass
        Mass matrix of the dofs; None where it is not known.
    """

    eigenvalues: ComplexArray
    vectors: ComplexArray = field(repr=False)
    shapes: ComplexArray = field(repr=False)
    dofs: tuple[Dof, ...] = field(repr=False)
    mass: SparseMatrix | None = field(default=None, repr=False)

    @property
    def frequencies(self) -> FloatArray:
        """Frequency of each oscillation in Hz, (n,); 0 for what does not oscillate."""
        return self.eigenvalues.imag / (2.0 * np.pi)

    @property
    def damping_ratio(self) -> FloatArray:
        """Ratio of critical damping, (n,): 1 or -1 for what decays or grows without oscillating.

        It is negative for an oscillation that grows, and 0 for a rigid motion.
        """
        sizes = np.abs(self.eigenvalues)
        still = np.zeros(len(sizes))
        return np.divide(-self.eigenvalues.real, sizes, out=still, where=sizes > 0.0)

    def whirl(self, axis: Sequence[float] = (1.0, 0.0, 0.0)) -> FloatArray:
        """Return how much each motion turns about an axis, (n,), from -1 to 1.

        It is 1 where all points go around on circles in the sense of the axis (forward whirl,
        for the axis of the spin), -1 where they go against it (backward), and 0 where they
        swing to and fro. Points are weighted by their kinetic energy.

        Parameters
        ----------
        axis
            Direction (x, y, z) of the spin.

        Raises
        ------
        InputError
            If the axis is not three finite numbers, or has no length.
        """
        about = unit_axis(axis)
        turned = turned_fields(self.dofs, self.shapes, about)
        across = -turned_fields(self.dofs, turned, about)
        around = self._products(turned, self.shapes).imag
        size = self._products(across, across).real
        return np.divide(-around, size, out=np.zeros(len(size)), where=size > 0.0)

    def _products(self, left: ComplexArray, right: ComplexArray) -> ComplexArray:
        """Return the products of pairs of fields in the mass matrix, (n,)."""
        weighted = right if self.mass is None else _times(self.mass, right)
        products: ComplexArray = np.sum(left.conj() * weighted, axis=0)
        return products


def complex_modes(basis: ModalBasis) -> ComplexModes:
    """Return the free motions of a basis with its damping, gyroscopic and circulatory matrices.

    They solve ``q'' + (C + G) q' + (diag(omega2) + N) q = 0`` as a system of first order
    (L. Meirovitch, Computational Methods in Structural Dynamics, Sijthoff and Noordhoff, 1980).

    Parameters
    ----------
    basis
        Any modal basis; its complex modes are as good as its modes are many.

    Examples
    --------
    >>> from bumpstop import ModalBasis
    >>> basis = ModalBasis.from_modes(
    ...     frequency=[3.0, 7.5], damping=[0.1, 1.25], shapes={("P", "dx"): [1.0, 0.4]}
    ... )
    >>> complex_modes(basis).damping_ratio.round(12).tolist()
    [1.0, 1.0, 0.1]
    """
    state = _State.of(basis)
    eigenvalues, vectors = np.linalg.eig(state.matrix)
    eigenvalues = np.asarray(eigenvalues, dtype=np.complex128)
    eigenvalues[np.abs(eigenvalues) <= NEGLIGIBLE * np.abs(eigenvalues).max()] = 0.0
    once = np.flatnonzero(eigenvalues.imag >= 0.0)
    order = once[np.lexsort((eigenvalues.real[once], eigenvalues.imag[once]))]
    coordinates = state.coordinates(eigenvalues[order], vectors[:, order])
    mass = None if basis.model is None else basis.model.mass
    shapes = _times(basis.shapes, coordinates)
    return ComplexModes(eigenvalues[order], coordinates, shapes, basis.dofs, mass)


class _State(NamedTuple):
    """The system of first order: velocities, and those displacements that make forces."""

    matrix: FloatArray
    held: NDArray[np.bool_]
    """Which modes have their displacement in the state, (N,)."""
    scale: FloatArray
    """What displacements are multiplied with in the state, in rad/s."""

    @classmethod
    def of(cls, basis: ModalBasis) -> _State:
        stiffness = np.diag(basis.omega2)
        if basis.circulatory is not None:
            stiffness = stiffness + basis.circulatory
        # The displacement of a rigid mode makes no force: left in, it would be a double
        # eigenvalue at zero, which rounding spreads to the square root of its size.
        held = np.abs(stiffness).max(axis=0) > 0.0
        scale = np.sqrt(np.abs(stiffness).max(axis=0)[held])
        damping = basis.damping_matrix
        velocities = np.diag(basis.damping) if damping is None else damping
        if basis.gyroscopic is not None:
            velocities = velocities + basis.gyroscopic
        count = len(scale)
        matrix = np.zeros((count + len(held), count + len(held)))
        matrix[np.arange(count), count + np.flatnonzero(held)] = scale
        matrix[count:, :count] = -stiffness[:, held] / scale
        matrix[count:, count:] = -velocities
        return cls(matrix, held, scale)

    def coordinates(self, eigenvalues: ComplexArray, vectors: ComplexArray) -> ComplexArray:
        """Return modal displacements of length one, the largest of each real and positive."""
        count = len(self.scale)
        velocities = vectors[count:]
        # A motion that is steady (a rigid one) is told by its velocity.
        found = velocities / np.where(eigenvalues == 0.0, 1.0, eigenvalues)
        found[self.held] = vectors[:count] / self.scale[:, np.newaxis]
        found /= np.linalg.norm(found, axis=0)
        largest = found[np.abs(found).argmax(axis=0), np.arange(found.shape[1])]
        phased: ComplexArray = found * (np.abs(largest) / largest)
        return phased


def _times(matrix: FloatArray | SparseMatrix, fields: ComplexArray) -> ComplexArray:
    """Return the product of a real matrix with complex fields."""
    product: ComplexArray = matrix @ fields.real + 1j * (matrix @ fields.imag)
    return product
