"""Which motions of their nodes the parts resist, each part in its own measure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bumpstop.structure.assembly import Contribution
from bumpstop.structure.mesh import Mesh
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["Resistance", "resistance"]


@dataclass(frozen=True, eq=False)
class Resistance:
    """What the parts of a structure resist.

    Parameters
    ----------
    rigid_edges
        Pairs of nodes joined by a part that resists every motion but that of a rigid body,
        (pairs, 2).
    strains
        Sums of dofs, one a row, that the other parts resist.
    """

    rigid_edges: IndexArray
    strains: SparseMatrix


def resistance(mesh: Mesh, parts: Sequence[Contribution]) -> Resistance:
    """Return what the stiffness of the parts resists."""
    rigid_edges = [_NO_EDGES]
    strains = [_NO_STRAINS]
    height = 0
    for part in parts:
        if not part.has("stiffness"):
            continue
        resisted = part.strains(mesh)
        if resisted is None:
            rigid_edges.append(_edges(part.nodes))
            continue
        element, row, column = np.nonzero(resisted)
        elements, rows, _ = resisted.shape
        dofs = mesh.dofs_of(part.nodes).reshape(elements, -1)
        places = height + rows * element + row, dofs[element, column]
        strains.append((*places, resisted[element, row, column]))
        height += rows * elements
    rows_of, columns_of, values = (np.concatenate(some) for some in zip(*strains, strict=True))
    return Resistance(
        rigid_edges=np.concatenate(rigid_edges),
        strains=SparseMatrix.from_triplets(
            (height, 6 * len(mesh.names)), rows_of, columns_of, values
        ),
    )


_NO_EDGES = np.zeros((0, 2), dtype=np.intp)
_NO_STRAINS = np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp), np.zeros(0)


def _edges(nodes: IndexArray) -> IndexArray:
    """Return pairs of each element's first node with its others."""
    others = nodes[:, 1:]
    first = np.repeat(nodes[:, :1], others.shape[1], axis=1)
    return np.stack([first, others], axis=2).reshape(-1, 2)
