"""Supports: dofs held at zero."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bumpstop.arguments import one_of
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.mesh import Mesh
from bumpstop.structure.names import names
from bumpstop.structure.sparse import IndexArray

__all__ = ["Support"]


@dataclass(frozen=True, kw_only=True)
class Support:
    """Dofs of nodes that cannot move.

    Parameters
    ----------
    nodes
        Names of the nodes, or ``"all"`` for every node of the mesh, those inside beams too.
    fixed
        The dofs held: any of ``dx dy dz drx dry drz``.

    Raises
    ------
    InputError
        If there is no node or no dof, or a dof is unknown.
    """

    nodes: str | Sequence[str]
    fixed: str | Sequence[str]

    def __post_init__(self) -> None:
        if self.nodes != "all":
            object.__setattr__(self, "nodes", names("nodes", self.nodes))
        for dof in names("fixed", self.fixed):
            one_of("fixed", dof, DOFS)
        object.__setattr__(self, "fixed", names("fixed", self.fixed))

    def held(self, mesh: Mesh, key: str) -> IndexArray:
        """Return the numbers of the dofs held; ``key`` tells errors which support this is."""
        if self.nodes == "all":
            nodes = np.arange(len(mesh.names))
        else:
            nodes = np.array([mesh.node(node, f"{key}.nodes") for node in self.nodes])
        dofs = [DOFS.index(dof) for dof in self.fixed]
        return mesh.dofs_of(nodes)[:, dofs].ravel()
