"""Connected components."""

from __future__ import annotations

from bumpstop.structure.sparse import IndexArray

__all__ = ["components"]


def components(size: int, rows: IndexArray, columns: IndexArray) -> list[list[int]]:
    """Return the connected components of a graph of ``size`` vertices.

    Edges join ``rows[i]`` and ``columns[i]``. Components are in the order of their lowest
    vertex, and ascending inside.

    Examples
    --------
    >>> import numpy as np
    >>> components(4, np.array([0, 3]), np.array([2, 3]))
    [[0, 2], [1], [3]]
    """
    parent = list(range(size))

    def root(vertex: int) -> int:
        while parent[vertex] != vertex:
            parent[vertex] = parent[parent[vertex]]
            vertex = parent[vertex]
        return vertex

    for row, column in zip(rows.tolist(), columns.tolist(), strict=True):
        low, high = sorted((root(row), root(column)))
        parent[high] = low
    groups: dict[int, list[int]] = {}
    for vertex in range(size):
        groups.setdefault(root(vertex), []).append(vertex)
    return list(groups.values())
