"""The motions that strain nothing, exactly.

Stiffness alone cannot tell a motion without any from one with very little: a soft spring under
a stiff frame is hidden in the rounding of the assembled matrix. So the question is put to one
part after the other. Elements that resist all but a rigid motion join their nodes to bodies;
a node of its own is a body too. What the bodies can do, six motions each, is then cut down by
supports, relations and the remaining elements, each in its own measure. What is left strains
nothing: rigid motions of the whole, of pieces of it, and mechanisms.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.assembly import Contribution
from bumpstop.structure.elimination import Freedom
from bumpstop.structure.frame import rigid_motions
from bumpstop.structure.graph import components
from bumpstop.structure.mesh import Mesh
from bumpstop.structure.null_combinations import null_combinations
from bumpstop.structure.resistance import resistance
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["rigid_fields"]

_CANCELLED = 1e-9
"""A sum this small beside the sizes of its terms is rounding."""


def rigid_fields(mesh: Mesh, parts: Sequence[Contribution], freedom: Freedom) -> FloatArray:
    """Return all motions on all dofs that strain nothing and that are free, (dofs, motions)."""
    resisted = resistance(mesh, parts)
    motions = _body_motions(mesh, resisted.rigid_edges, freedom)
    zeros = _relative_product(_ties(freedom).stacked(resisted.strains), motions)
    return motions @ null_combinations(zeros)


def _ties(freedom: Freedom) -> SparseMatrix:
    """Return what supports and relations let be zero: each dependent dof less its sum."""
    expansion = freedom.expansion
    is_dependent = np.ones(expansion.shape[0], dtype=bool)
    is_dependent[freedom.free] = False
    dependent = np.flatnonzero(is_dependent)
    row = np.cumsum(is_dependent) - 1
    inside = is_dependent[expansion.rows]
    return SparseMatrix.from_triplets(
        (len(dependent), len(row)),
        np.concatenate([np.arange(len(dependent)), row[expansion.rows[inside]]]),
        np.concatenate([dependent, freedom.free[expansion.columns[inside]]]),
        np.concatenate([np.ones(len(dependent)), -expansion.values[inside]]),
    )


def _body_motions(mesh: Mesh, edges: IndexArray, freedom: Freedom) -> SparseMatrix:
    """Return six motions for each body of joined nodes, one a column.

    They are scaled so that nothing moves by more than about one.
    """
    held = np.ones((len(mesh.names), 6), dtype=bool)
    held.flat[freedom.free] = False
    rows, columns, values = [], [], []
    for number, body in enumerate(components(len(mesh.names), edges[:, 0], edges[:, 1])):
        nodes = np.array(body)
        positions = mesh.positions[nodes]
        # Motions about a held node are the simplest to write: a hinge leaves a plain rotation.
        about = positions[held[nodes, :3].sum(axis=1).argmax()]
        size = _power_of_two(np.abs(positions - about).max())
        motions = rigid_motions((positions - about) / size, np.zeros(3)).reshape(-1, 6, 6)
        motions[:, 3:] /= size
        node, dof, motion = np.nonzero(motions)
        rows.append(6 * nodes[node] + dof)
        columns.append(6 * number + motion)
        values.append(motions[node, dof, motion])
    return SparseMatrix.from_triplets(
        (6 * len(mesh.names), 6 * len(rows)),
        np.concatenate(rows),
        np.concatenate(columns),
        np.concatenate(values),
    )


def _relative_product(zeros: SparseMatrix, motions: SparseMatrix) -> SparseMatrix:
    """Return what must be zero by the motions of the bodies, each row of order one."""
    product = zeros.times(motions)
    sizes = zeros.magnitudes().times(motions.magnitudes()).values
    row_sizes = np.zeros(zeros.shape[0])
    np.maximum.at(row_sizes, product.rows, sizes)
    relative = replace(product, values=product.values / row_sizes[product.rows])
    return relative.where(np.abs(product.values) > _CANCELLED * sizes)


def _power_of_two(size: float) -> float:
    """Return a power of two near ``size``, so that scaling by it rounds nothing; 1 for 0."""
    return float(2.0 ** np.round(np.log2(size))) if size > 0.0 else 1.0
