"""Which motions of their nodes the parts resist, each part in its own measure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.assembly import Block
from bumpstop.structure.echelon import row_space
from bumpstop.structure.frame import rigid_motions
from bumpstop.structure.mesh import Mesh
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["Resistance", "resistance"]

_CANCELLED = 1e-12
"""Forces this small beside the sizes of their terms are rounding."""


@dataclass(frozen=True, eq=False)
class Resistance:
    """What the parts of a structure resist.

    Parameters
    ----------
    edges
        Pairs of nodes that a part joins, (pairs, 2).
    rigid_edges
        Those of them whose part resists every motion but that of a rigid body.
    strains
        Sums of dofs, one a row, that the other parts resist.
    """

    edges: IndexArray
    rigid_edges: IndexArray
    strains: SparseMatrix


def resistance(mesh: Mesh, blocks: Sequence[Block]) -> Resistance:
    """Return what the stiffness of the blocks resists."""
    edges, rigid_edges = [_NO_EDGES], [_NO_EDGES]
    strains = [_NO_STRAINS]
    height = 0
    known: dict[tuple[bytes, bytes], _Kind] = {}
    for block in blocks:
        if block.stiffness is None:
            continue
        # The struts of a lattice are many, but few are different.
        offsets = _offsets(mesh, block.dofs)
        key = block.stiffness.tobytes(), offsets.tobytes()
        if key not in known:
            known[key] = _kind(block.stiffness, block.dofs, offsets)
        kind = known[key]
        edges.append(_edges(block.dofs))
        if kind.rigid:
            rigid_edges.append(edges[-1])
        else:
            row, column = np.nonzero(kind.strains)
            count = len(block.dofs)
            first = height + len(kind.strains) * np.arange(count)[:, np.newaxis]
            rows, columns = (first + row).ravel(), block.dofs[:, column].ravel()
            strains.append((rows, columns, np.tile(kind.strains[row, column], count)))
            height += len(kind.strains) * count
    rows, columns, values = (np.concatenate(part) for part in zip(*strains, strict=True))
    return Resistance(
        edges=np.concatenate(edges),
        rigid_edges=np.concatenate(rigid_edges),
        strains=SparseMatrix.from_triplets((height, 6 * len(mesh.names)), rows, columns, values),
    )


_NO_EDGES = np.zeros((0, 2), dtype=np.intp)
_NO_STRAINS = np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp), np.zeros(0)


@dataclass(frozen=True, eq=False)
class _Kind:
    """What one element resists: independent sums of its dofs; whether all but rigid motions."""

    strains: FloatArray
    rigid: bool


def _kind(stiffness: FloatArray, dofs: IndexArray, offsets: FloatArray) -> _Kind:
    diagonal = np.abs(stiffness.diagonal())
    scale = np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    strains = row_space(stiffness / np.outer(scale, scale)) * scale
    return _Kind(strains, _is_rigid(stiffness, len(strains), dofs, offsets))


def _is_rigid(stiffness: FloatArray, rank: int, dofs: IndexArray, offsets: FloatArray) -> bool:
    """Return whether elements of whole nodes resist all but the motions of a rigid body."""
    size = dofs.shape[1]
    if rank != size - 6 or not np.array_equal(
        dofs % 6, np.tile(np.arange(size) % 6, (len(dofs), 1))
    ):
        return False
    for places in offsets.reshape(len(dofs), -1, 6, 3)[:, :, 0]:
        motions = rigid_motions(places, np.zeros(3))
        forces = np.abs(stiffness @ motions)
        if np.any(forces > _CANCELLED * (np.abs(stiffness) @ np.abs(motions))):
            return False
    return True


def _offsets(mesh: Mesh, dofs: IndexArray) -> FloatArray:
    """Return where the node of each dof is from the first one of its element."""
    places = mesh.positions[dofs // 6]
    return places - places[:, :1]


def _edges(dofs: IndexArray) -> IndexArray:
    """Return pairs of each element's first node with its others."""
    nodes = dofs // 6
    new = np.flatnonzero(np.diff(nodes[0])) + 1
    return np.stack([np.repeat(nodes[:, :1], len(new), axis=1), nodes[:, new]], axis=2).reshape(
        -1, 2
    )
