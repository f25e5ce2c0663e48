"""The rigid motions that a structure's supports leave it, exactly."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bumpstop.arguments import FloatArray
from bumpstop.structure.echelon import null_space
from bumpstop.structure.frame import rigid_motions
from bumpstop.structure.graph import components
from bumpstop.structure.mesh import Mesh
from bumpstop.structure.sparse import IndexArray, SparseMatrix

__all__ = ["rigid_shapes"]


def rigid_shapes(mesh: Mesh, stiffness: SparseMatrix, free: IndexArray) -> FloatArray:
    """Return all motions that strain nothing, (free dofs, motions).

    Each piece of the structure that hangs together has its own. They come from geometry
    alone: the six motions of a rigid body, less those that the piece's supports forbid.
    Every part is free in space by itself, so these are the whole null space of the stiffness
    matrix; a part that holds on to the ground would have to count as a support here.
    """
    pieces = components(len(mesh.names), stiffness.rows // 6, stiffness.columns // 6)
    held = np.ones(stiffness.shape[0], dtype=bool)
    held[free] = False
    shapes = [_piece_shapes(mesh, np.array(nodes), held) for nodes in pieces]
    return np.hstack(shapes)[free]


def _piece_shapes(mesh: Mesh, nodes: IndexArray, held: NDArray[np.bool_]) -> FloatArray:
    """Return the rigid motions of one piece on all dofs of the structure."""
    positions = mesh.positions[nodes]
    dofs = mesh.dofs_of(nodes)
    # Motions about a held node are the simplest to write: a hinge leaves a plain rotation.
    about = positions[held[dofs][:, :3].sum(axis=1).argmax()]
    size = _power_of_two(np.abs(positions - about).max())
    motions = rigid_motions((positions - about) / size, np.zeros(3))
    allowed: FloatArray = motions @ null_space(motions[held[dofs.ravel()]])
    allowed.reshape(len(nodes), 6, -1)[:, 3:] /= size
    shapes = np.zeros((len(held), allowed.shape[1]))
    shapes[dofs.ravel()] = allowed
    return shapes


def _power_of_two(size: float) -> float:
    """Return a power of two near ``size``, so that scaling by it rounds nothing; 1 for 0."""
    return float(2.0 ** np.round(np.log2(size))) if size > 0.0 else 1.0
