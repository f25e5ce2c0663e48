"""The mesh: every node by name, those the user gave and those inside beams."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bumpstop.arguments import FloatArray, did_you_mean, name, vector
from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS, Dof
from bumpstop.structure.sparse import IndexArray

__all__ = ["Mesh", "user_nodes"]


@dataclass(frozen=True, eq=False)
class Mesh:
    """Nodes in the order of the matrices: six dofs each.

    Parameters
    ----------
    names
        Name of each node.
    positions
        Coordinates in m, (nodes, 3).
    """

    names: tuple[str, ...]
    positions: FloatArray

    def with_nodes(self, names: Iterable[str], positions: Iterable[FloatArray]) -> Mesh:
        """Return the mesh with more nodes at its end."""
        return Mesh((*self.names, *names), np.concatenate([self.positions, *positions]))

    def node(self, node: str, key: str = "node") -> int:
        """Return the number of a node.

        Raises
        ------
        InputError
            If no node has that name.
        """
        if node not in self._numbers:
            hint = did_you_mean(node, self.names)
            raise InputError("unknown node", key=key, value=node, hint=hint)
        return self._numbers[node]

    def dofs_of(self, nodes: IndexArray) -> IndexArray:
        """Return the numbers of all dofs of nodes: one more axis, of length 6."""
        return 6 * nodes[..., np.newaxis] + np.arange(6)

    @cached_property
    def size(self) -> float:
        """Longest side of the box around all nodes, in m; 1 where they are at one place."""
        return float(np.ptp(self.positions, axis=0).max()) or 1.0

    @cached_property
    def dofs(self) -> tuple[Dof, ...]:
        """Node and dof of each row of the matrices."""
        return tuple((node, dof) for node in self.names for dof in DOFS)

    @cached_property
    def _numbers(self) -> dict[str, int]:
        return {node: number for number, node in enumerate(self.names)}


def user_nodes(nodes: Mapping[str, object]) -> Mesh:
    """Return the mesh of the nodes that the user gave by name.

    Raises
    ------
    InputError
        If there is none, a name cannot be used, or coordinates are not three finite numbers.
    """
    if not isinstance(nodes, Mapping) or not nodes:
        raise InputError("must name at least one node", key="nodes", value=nodes)
    positions = [vector(f"nodes.{_node_name(node)}", place) for node, place in nodes.items()]
    return Mesh(tuple(nodes), np.array(positions))


def _node_name(value: object) -> str:
    node = name("nodes", value)
    if node == "all" or "@" in node:
        what = "a node cannot be called 'all', nor have '@' in its name"
        raise InputError(what, key="nodes", value=value)
    return node
