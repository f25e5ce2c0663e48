"""Where the entries of a matrix lie that couples nodes of six dofs each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["Pattern"]


@dataclass(frozen=True, eq=False)
class Pattern:
    """The pairs of nodes that parts couple, in the order of the columns of a matrix.

    Each pair holds a block of 6 x 6 entries; these lie column by column, as compressed sparse
    columns do. Sorting pairs of nodes instead of entries is what makes assembly fast.

    Parameters
    ----------
    nodes
        Number of nodes.
    rows, columns
        The two nodes of each pair.
    places
        For each of the parts, the number of the pair of any two of its nodes, (elements, m, m).
    """

    nodes: int
    rows: IndexArray
    columns: IndexArray
    places: list[IndexArray]

    @classmethod
    def of(cls, nodes: int, parts: Sequence[IndexArray]) -> Pattern:
        """Return the pattern of parts that each couple some nodes, (elements, m)."""
        keys = [part[:, np.newaxis, :] * nodes + part[:, :, np.newaxis] for part in parts]
        all_keys = np.concatenate([key.ravel() for key in keys])
        pairs, place = np.unique(all_keys, return_inverse=True)
        ends = np.cumsum([key.size for key in keys])[:-1]
        places = [
            some.reshape(key.shape) for some, key in zip(np.split(place, ends), keys, strict=True)
        ]
        return cls(nodes, pairs % nodes, pairs // nodes, places)

    @property
    def size(self) -> int:
        """Number of entries."""
        return 36 * len(self.rows)

    def entries(self, part: int) -> IndexArray:
        """Return where the entries of a part's matrices go, (elements, 6 m, 6 m)."""
        pairs = self.places[part]
        elements, m, _ = pairs.shape
        six = np.arange(6)
        first = self._first[pairs][:, :, np.newaxis, :, np.newaxis] + six[:, np.newaxis, np.newaxis]
        step = self._height[pairs][:, :, np.newaxis, :, np.newaxis]
        entries: IndexArray = (first + step * six).reshape(elements, 6 * m, 6 * m)
        return entries

    def matrix(self, values: FloatArray) -> SparseMatrix:
        """Return the matrix of all entries, leaving out those that are exactly zero."""
        size = 6 * self.nodes
        kept = np.flatnonzero(values)
        if len(kept) == len(values):
            return SparseMatrix((size, size), self._starts, self._entry_rows, values)
        starts = np.searchsorted(kept, self._starts)
        return SparseMatrix((size, size), starts, self._entry_rows[kept], values[kept])

    @cached_property
    def _starts(self) -> IndexArray:
        """Where each column starts among the entries, (6 nodes + 1,)."""
        heights = np.repeat(6 * self._count, 6)
        starts: IndexArray = np.concatenate([[0], np.cumsum(heights)])
        return starts

    @cached_property
    def _entry_rows(self) -> IndexArray:
        """Row of each entry."""
        rows = np.empty(self.size, dtype=np.intp)
        six = np.arange(6)
        block_rows = 6 * self.rows[:, np.newaxis] + six
        for column in range(6):
            first = self._first + column * self._height
            rows[first[:, np.newaxis] + six] = block_rows
        return rows

    @cached_property
    def _count(self) -> IndexArray:
        """Number of pairs in the columns of each node."""
        count: IndexArray = np.bincount(self.columns, minlength=self.nodes)
        return count

    @cached_property
    def _height(self) -> IndexArray:
        """Number of entries in each column of a pair's block and of those above and below it."""
        return 6 * self._count[self.columns]

    @cached_property
    def _first(self) -> IndexArray:
        """Where each pair's first entry lies."""
        first_pair = (np.cumsum(self._count) - self._count)[self.columns]
        first: IndexArray = 36 * first_pair + 6 * (np.arange(len(self.columns)) - first_pair)
        return first
