"""Component: a model with the nodes at which others are joined to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeAlias

import numpy as np

from bumpstop.arguments import did_you_mean, name, one_of, refuse_twins
from bumpstop.errors import InputError
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.model import LinearModel
from bumpstop.structure.sparse import IndexArray

__all__ = ["Component", "InterfaceNode"]

InterfaceNode: TypeAlias = tuple[str, tuple[str, ...]]
"""A node's name, and its dofs at which others may be joined."""


@dataclass(frozen=True, eq=False)
class Component:
    """A linear model that becomes part of larger ones through a few of its nodes.

    Parameters
    ----------
    model
        A ``Structure``, an ``Assembly``, or any other linear model. Its own supports and
        relations stay with it wherever it is placed.
    interface
        The nodes at which it may be joined or held: names, for all dofs that can move, or
        pairs of a name and the dofs, such as ``("B", ("dx", "dy"))``.

    Raises
    ------
    InputError
        If there is no interface, a node or dof is unknown, named twice, held by the
        component's own supports or led by other dofs.

    Examples
    --------
    >>> from bumpstop import Beam, Material, Rectangle, Structure
    >>> steel = Material(young_modulus=210e9, poisson_ratio=0.3, density=7800.0)
    >>> bar = Rectangle(height=0.02, width=0.02)
    >>> beam = Beam("AB", nodes=("A", "B"), elements=4, material=steel, section=bar)
    >>> bay = Component(
    ...     Structure(nodes={"A": (0, 0, 0), "B": (1, 0, 0)}, beams=[beam]), interface=["A", "B"]
    ... )
    >>> len(bay.boundary)
    12
    """

    model: LinearModel = field(repr=False)
    interface: Sequence[str | tuple[str, str | Sequence[str]]]

    def __post_init__(self) -> None:
        if not hasattr(self.model, "rigid_shapes"):
            what = "must be a structure, an assembly or another linear model"
            raise InputError(what, key="model", value=type(self.model).__name__)
        listed = self.interface
        if not isinstance(listed, list | tuple) or not listed:
            hint = 'such as ["A", "B"]'
            raise InputError("must list its nodes", key="interface", value=listed, hint=hint)
        nodes = [self._interface_node(item) for item in listed]
        refuse_twins("interface", [node for node, _ in nodes])
        object.__setattr__(self, "interface", tuple(nodes))

    @cached_property
    def boundary(self) -> IndexArray:
        """Numbers of the interface's dofs in the model, in the order of the interface."""
        return np.array([self._rows[node, dof] for node, dofs in self.nodes for dof in dofs])

    @cached_property
    def boundary_coordinates(self) -> IndexArray:
        """Which of the model's independent dofs the interface's are, in the same order."""
        return np.searchsorted(self.model.free, self.boundary)

    @property
    def nodes(self) -> Sequence[InterfaceNode]:
        """The interface's nodes with their dofs."""
        nodes: Sequence[InterfaceNode] = self.interface  # type: ignore[assignment]
        return nodes

    @cached_property
    def _rows(self) -> dict[tuple[str, str], int]:
        return {dof: row for row, dof in enumerate(self.model.dofs)}

    @cached_property
    def _free(self) -> frozenset[int]:
        return frozenset(self.model.free.tolist())

    @cached_property
    def _moving(self) -> frozenset[int]:
        """Dofs that can move at all, by themselves or because others lead them."""
        expansion = self.model.expansion
        return frozenset(expansion.rows[expansion.values != 0.0].tolist())

    def _interface_node(self, item: object) -> InterfaceNode:
        if isinstance(item, str):
            return item, self._free_dofs(item)
        if not isinstance(item, list | tuple) or len(item) != 2:
            what = "must hold names of nodes, or pairs of a name and dofs"
            raise InputError(what, key="interface", value=item)
        node, dofs = item
        known = self._known_dofs(node)
        asked = [dofs] if isinstance(dofs, str) else dofs
        if not isinstance(asked, list | tuple) or not asked:
            raise InputError("must list dofs", key=f"interface.{node}", value=dofs)
        for dof in asked:
            one_of("dof", dof, known)
            self._require_free(node, dof)
        refuse_twins(f"interface.{node}", asked)
        return node, tuple(asked)

    def _free_dofs(self, node: str) -> tuple[str, ...]:
        """Return the dofs of a node that can move."""
        moving = [dof for dof in self._known_dofs(node) if self._rows[node, dof] in self._moving]
        if not moving:
            what, hint = "cannot be joined: its component holds it", "take that support away"
            raise InputError(what, key="interface", value=node, hint=hint)
        for dof in moving:
            self._require_free(node, dof)
        return tuple(moving)

    def _known_dofs(self, node: object) -> tuple[str, ...]:
        known = tuple(dof for dof in DOFS if (name("interface", node), dof) in self._rows)
        if not known:
            hint = did_you_mean(node, dict.fromkeys(own for own, _ in self.model.dofs))
            raise InputError("unknown node", key="interface", value=node, hint=hint)
        return known

    def _require_free(self, node: str, dof: str) -> None:
        row = self._rows[node, dof]
        if row in self._free:
            return
        what, hint = f"{dof} is held by the component's own supports", "take that support away"
        if row in self._moving:
            what = f"{dof} follows other dofs, by a relation or because it has no inertia"
            hint = "name the dofs at which the node can be joined, or let it lead"
        raise InputError(what, key="interface", value=node, hint=hint)
