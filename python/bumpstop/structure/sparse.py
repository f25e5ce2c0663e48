"""A small sparse matrix, so that assembling needs no SciPy."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from bumpstop._core import assemble, sparse_product
from bumpstop.arguments import FloatArray

if TYPE_CHECKING:
    from scipy.sparse import csc_array

__all__ = ["IndexArray", "SparseMatrix"]

IndexArray: TypeAlias = NDArray[np.intp]

_CANCELLED = 1e-14
"""An entry this small beside the sizes of the terms that it is the sum of is rounding."""


@dataclass(frozen=True, eq=False)
class SparseMatrix:
    """A matrix in compressed sparse columns.

    Parameters
    ----------
    shape
        Numbers of rows and columns.
    starts
        Where each column starts in ``rows`` and ``values``, (columns + 1,).
    rows
        Row of each entry, ascending within a column.
    values
        Value of each entry.
    """

    shape: tuple[int, int]
    starts: IndexArray
    rows: IndexArray
    values: FloatArray

    @classmethod
    def from_triplets(
        cls, shape: tuple[int, int], rows: IndexArray, columns: IndexArray, values: FloatArray
    ) -> SparseMatrix:
        """Add up triplets; those of one place are summed in the order given.

        Examples
        --------
        >>> import numpy as np
        >>> twice, once = np.array([0, 1, 0]), np.array([0, 1, 0])
        >>> SparseMatrix.from_triplets((2, 2), twice, once, np.array([1.0, 5.0, 2.0])).to_dense()
        array([[3., 0.],
               [0., 5.]])
        """
        return cls(shape, *assemble(rows, columns, values, shape))

    @classmethod
    def zeros(cls, size: int) -> SparseMatrix:
        """Return a square matrix without entries."""
        nothing = np.zeros(0, dtype=np.intp)
        return cls((size, size), np.zeros(size + 1, dtype=np.intp), nothing, np.zeros(0))

    @classmethod
    def selection(cls, size: int, kept: IndexArray) -> SparseMatrix:
        """Return the matrix (size, kept) that puts values at the rows ``kept``, zeros elsewhere."""
        return cls((size, len(kept)), np.arange(len(kept) + 1), kept, np.ones(len(kept)))

    @property
    def arrays(self) -> tuple[IndexArray, IndexArray, FloatArray]:
        """What the core takes for the matrix: ``starts``, ``rows`` and ``values``."""
        return self.starts, self.rows, self.values

    @property
    def columns(self) -> IndexArray:
        """Column of each entry."""
        return np.repeat(np.arange(self.shape[1]), np.diff(self.starts))

    def diagonal(self) -> FloatArray:
        """Return the entries on the diagonal."""
        on_diagonal = self.rows == self.columns
        diagonal = np.zeros(min(self.shape))
        diagonal[self.rows[on_diagonal]] = self.values[on_diagonal]
        return diagonal

    def restricted(self, kept: IndexArray) -> SparseMatrix:
        """Return the square matrix of the rows and columns in ``kept``, ascending."""
        if len(kept) == self.shape[0]:
            return self
        place = np.full(self.shape[0], -1, dtype=np.intp)
        place[kept] = np.arange(len(kept))
        rows, columns = place[self.rows], place[self.columns]
        inside = (rows >= 0) & (columns >= 0)
        size = len(kept)
        # The entries are in their order already.
        heights = np.bincount(columns[inside], minlength=size)
        starts = np.concatenate([[0], np.cumsum(heights)])
        return SparseMatrix((size, size), starts, rows[inside], self.values[inside])

    def transposed(self) -> SparseMatrix:
        """Return the transpose."""
        return SparseMatrix.from_triplets(
            (self.shape[1], self.shape[0]), self.columns, self.rows, self.values
        )

    def magnitudes(self) -> SparseMatrix:
        """Return the matrix of the entries' absolute values."""
        return SparseMatrix(self.shape, self.starts, self.rows, np.abs(self.values))

    def stacked(self, below: SparseMatrix) -> SparseMatrix:
        """Return the matrix with the rows of another one below its own."""
        return SparseMatrix.from_triplets(
            (self.shape[0] + below.shape[0], self.shape[1]),
            np.concatenate([self.rows, self.shape[0] + below.rows]),
            np.concatenate([self.columns, below.columns]),
            np.concatenate([self.values, below.values]),
        )

    def times(self, other: SparseMatrix) -> SparseMatrix:
        """Return the product with another sparse matrix."""
        # Each entry (k, j) of the other adds its multiple of our column k to column j.
        lengths = np.diff(self.starts)[other.rows]
        ours = np.arange(lengths.sum()) + np.repeat(
            self.starts[other.rows] - (np.cumsum(lengths) - lengths), lengths
        )
        return SparseMatrix.from_triplets(
            (self.shape[0], other.shape[1]),
            self.rows[ours],
            np.repeat(other.columns, lengths),
            self.values[ours] * np.repeat(other.values, lengths),
        )

    def plus(self, other: SparseMatrix) -> SparseMatrix:
        """Return the sum with another matrix of the same shape."""
        return SparseMatrix.from_triplets(
            self.shape,
            np.concatenate([self.rows, other.rows]),
            np.concatenate([self.columns, other.columns]),
            np.concatenate([self.values, other.values]),
        )

    def scaled(self, factor: float) -> SparseMatrix:
        """Return the matrix times a number."""
        return SparseMatrix(self.shape, self.starts, self.rows, factor * self.values)

    def congruent(self, expansion: SparseMatrix) -> SparseMatrix:
        """Return expansion' @ self @ expansion, without entries that only rounding left.

        A symmetric matrix stays symmetric, and a skew-symmetric one skew-symmetric, to the bit.
        """
        across = expansion.transposed()
        product = across.times(self.times(expansion))
        sizes = across.magnitudes().times(self.magnitudes().times(expansion.magnitudes()))
        product = product.where(np.abs(product.values) > _CANCELLED * sizes.values)
        sign = self.mirror_sign()
        if sign is None:
            return product
        return product.plus(product.transposed().scaled(sign)).scaled(0.5)

    def mirror_sign(self) -> float | None:
        """Return 1.0 for a matrix that is symmetric to the bit, -1.0 for a skew one, else None."""
        across = self.transposed()
        same_places = np.array_equal(across.starts, self.starts) and np.array_equal(
            across.rows, self.rows
        )
        for sign in (1.0, -1.0):
            if same_places and np.array_equal(across.values, sign * self.values):
                return sign
        return None

    def where(self, kept: NDArray[np.bool_]) -> SparseMatrix:
        """Return the matrix with some of its entries only, (entries,)."""
        count = np.concatenate([[0], np.cumsum(kept)])
        return SparseMatrix(self.shape, count[self.starts], self.rows[kept], self.values[kept])

    def dense_columns(self, numbers: IndexArray) -> tuple[IndexArray, FloatArray]:
        """Return a few columns: the rows where they have entries, and the entries there."""
        lengths = np.diff(self.starts)[numbers]
        column = np.repeat(np.arange(len(numbers)), lengths)
        first = np.repeat(self.starts[numbers] - (np.cumsum(lengths) - lengths), lengths)
        entries = first + np.arange(len(first))
        rows, row = np.unique(self.rows[entries], return_inverse=True)
        dense = np.zeros((len(rows), len(numbers)))
        dense[row, column] = self.values[entries]
        return rows, dense

    def to_dense(self) -> FloatArray:
        """Return the matrix as a NumPy array."""
        dense = np.zeros(self.shape)
        dense[self.rows, self.columns] = self.values
        return dense

    def to_scipy(self) -> csc_array:
        """Return the matrix as a SciPy sparse array."""
        from scipy.sparse import csc_array

        return csc_array((self.values, self.rows, self.starts), shape=self.shape)

    def __matmul__(self, field: FloatArray) -> FloatArray:
        """Return the product with a vector (columns,) or with several, (columns, m)."""
        vectors = field.reshape(self.shape[1], math.prod(field.shape[1:]))
        product = sparse_product(self.arrays, self.shape[0], vectors)
        return product.reshape(self.shape[0], *field.shape[1:])
