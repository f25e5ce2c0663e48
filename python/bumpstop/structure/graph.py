"""Connected components."""

from __future__ import annotations

import numpy as np

from bumpstop._core import component_labels
from bumpstop.structure.sparse import IndexArray

__all__ = ["components"]


def components(size: int, rows: IndexArray, columns: IndexArray) -> list[IndexArray]:
    """Return the connected components of a graph of ``size`` vertices.

    Edges join ``rows[i]`` and ``columns[i]``. Components are in the order of their lowest
    vertex, and ascending inside.

    Examples
    --------
    >>> components(4, np.array([0, 3]), np.array([2, 3]))
    [array([0, 2]), array([1]), array([3])]
    """
    if size == 0:
        return []
    labels = component_labels(size, rows, columns)
    order = np.argsort(labels, kind="stable")
    firsts = np.flatnonzero(np.diff(labels[order])) + 1
    return np.split(order, firsts)
