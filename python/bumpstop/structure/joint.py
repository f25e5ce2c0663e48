"""How a small part holds a node to the ground, or one node to another."""

from __future__ import annotations

import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.structure.frame import rigid_motions
from bumpstop.structure.mesh import Mesh
from bumpstop.structure.sparse import IndexArray

__all__ = ["Joint"]


class Joint:
    """The nodes that a part joins, and the motion that it sees between them.

    Where its two nodes are apart, the part sits halfway between them, on rigid arms: a motion
    of a rigid body does not strain it.

    Parameters
    ----------
    mesh
        The mesh.
    node, other
        Names of the nodes; without an ``other`` the node is held to the ground.
    key
        The part's place in the input, for errors: ``"springs.k1"``.

    Raises
    ------
    InputError
        If a node is unknown.
    """

    def __init__(self, mesh: Mesh, node: str, other: str | None, key: str) -> None:
        numbers = [mesh.node(node, f"{key}.node")]
        if other is not None:
            numbers.append(mesh.node(other, f"{key}.other"))
        self.nodes: IndexArray = np.array(numbers)
        self._places = mesh.positions[self.nodes]

    @property
    def along(self) -> FloatArray:
        """Vector from the node to the other one, in m; zero for one that is held to the ground."""
        vector: FloatArray = self._places[-1] - self._places[0]
        return vector

    def relative(self) -> FloatArray:
        """Return the motion of the other node seen from the first, (6, 6 nodes).

        Rows are displacement along and rotation about the global axes. Of one node it is the
        node's own motion.
        """
        if len(self.nodes) == 1:
            return np.eye(6)
        middle = self._places.mean(axis=0, keepdims=True)
        first, last = (rigid_motions(middle, place) for place in self._places)
        return np.hstack([-first, last])

    def matrix(self, local: FloatArray, axes: FloatArray) -> FloatArray:
        """Return a matrix (6, 6) of the relative motion in local axes, on the nodes' dofs.

        What is symmetric or skew-symmetric stays so to the bit.
        """
        motion = np.kron(np.eye(2), axes) @ self.relative()
        matrix: FloatArray = motion.T @ local @ motion
        if np.array_equal(local, local.T):
            return 0.5 * (matrix + matrix.T)
        if np.array_equal(local, -local.T):
            return 0.5 * (matrix - matrix.T)
        return matrix
