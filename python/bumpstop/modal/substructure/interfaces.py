"""The interface nodes of all parts of an assembly, and the equations that tie them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations

import numpy as np

from bumpstop.arguments import FloatArray, did_you_mean
from bumpstop.errors import InputError
from bumpstop.modal.substructure.joint import Joint
from bumpstop.modal.substructure.part import Part
from bumpstop.structure.dofs import DOFS
from bumpstop.structure.support import Support

__all__ = ["Interfaces"]

_ROUNDING = 1e-10
"""How far apart joined nodes may be, relative to the size of the assembly."""


class Interfaces:
    """Interface nodes by name, with their part before them: ``"left.B"``.

    Parameters
    ----------
    parts
        The parts by name.
    coordinates
        Where the coordinates of each part stand among those of all.
    """

    def __init__(self, parts: Mapping[str, Part], coordinates: Mapping[str, slice]) -> None:
        self._nodes = {
            f"{name}.{node}": (part, node, coordinates[name])
            for name, part in parts.items()
            for node in part.interface
        }
        self._count = max(place.stop for place in coordinates.values())

    def equations(self, joints: Sequence[Joint], supports: Sequence[Support]) -> FloatArray:
        """Return what joints and supports demand to be zero, (equations, coordinates).

        Raises
        ------
        InputError
            If a node is unknown or has not the dofs, or nodes are joined that are at different
            places or joined already.
        """
        rows = [np.zeros((0, self._count))]
        tied = _Groups()
        for number, joint in enumerate(joints):
            rows += self._joined(joint, f"joints[{number}]", tied)
        for number, support in enumerate(supports):
            rows += self._held(support, f"supports[{number}]")
        equations = np.vstack(rows)
        return equations[equations.any(axis=1)]

    def coincident(self, joints: Iterable[Joint]) -> list[Joint]:
        """Return joints of the nodes of different parts at one place that are not joined yet."""
        tied = _Groups()
        for joint in joints:
            tied.unite(joint.first, joint.second)
        places = {node: self._position(node) for node in self._nodes}
        found = []
        for first, second in combinations(self._nodes, 2):
            near = np.abs(places[first] - places[second]).max() <= self._tolerance
            other_part = self._nodes[first][0] is not self._nodes[second][0]
            if near and other_part and tied.unite(first, second):
                found.append(Joint(first, second))
        return found

    def _joined(self, joint: Joint, key: str, tied: _Groups) -> list[FloatArray]:
        pair = joint.first, joint.second
        for node in pair:
            self._require(node, key)
        self._require_one_place(joint, key)
        dofs = self._shared(joint, key) if joint.dofs is None else joint.dofs
        rows, news = [], []
        for dof in dofs:
            first, second = (self._known_tie(node, dof, key) for node in pair)
            rows.append(first - second)
            news.append(tied.unite(f"{pair[0]} {dof}", f"{pair[1]} {dof}"))
        if not any(news):
            what = f"{pair[0]} and {pair[1]} are joined already"
            raise InputError(what, key=key, hint="directly, or through joints with others")
        return rows

    def _shared(self, joint: Joint, key: str) -> list[str]:
        """Return all dofs in which one of two nodes can move; the other must know them."""
        ties = {dof: [self._tie(node, dof) for node in (joint.first, joint.second)] for dof in DOFS}
        shared = [dof for dof in DOFS if any(tie is not None and tie.any() for tie in ties[dof])]
        if any(tie is None for dof in shared for tie in ties[dof]):
            known = [
                " ".join(dof for dof in DOFS if ties[dof][side] is not None) for side in (0, 1)
            ]
            what = (
                f"the interfaces have different dofs: {joint.first} has {known[0]}, "
                f"{joint.second} has {known[1]}"
            )
            raise InputError(what, key=key, hint="name the dofs that they share")
        return shared

    def _held(self, support: Support, key: str) -> list[FloatArray]:
        if support.nodes == "all":
            what, hint = "must name interface nodes", "hold whole components in their own model"
            raise InputError(what, key=f"{key}.nodes", value="all", hint=hint)
        rows = []
        for node in support.nodes:
            self._require(node, f"{key}.nodes")
            rows += [self._known_tie(node, dof, f"{key}.fixed") for dof in support.fixed]
        return rows

    def _require(self, node: str, key: str) -> None:
        if node not in self._nodes:
            hint = did_you_mean(node, self._nodes)
            raise InputError("is not an interface node", key=key, value=node, hint=hint)

    def _require_one_place(self, joint: Joint, key: str) -> None:
        first, second = self._position(joint.first), self._position(joint.second)
        if np.abs(first - second).max() > self._tolerance:
            places = " and ".join(f"({', '.join(f'{x:.10g}' for x in p)})" for p in (first, second))
            what = f"{joint.first} and {joint.second} are at different places, {places}"
            raise InputError(what, key=key)

    def _known_tie(self, node: str, dof: str, key: str) -> FloatArray:
        tie = self._tie(node, dof)
        if tie is None:
            known = [own for own in DOFS if self._tie(node, own) is not None]
            hint = f"along the global axes it has {', '.join(known)}" if known else None
            raise InputError(f"{dof} is not in the interface of {node}", key=key, hint=hint)
        return tie

    def _tie(self, node: str, dof: str) -> FloatArray | None:
        """Return a dof of a node by the coordinates of all parts, or None where it is not known."""
        part, inner, place = self._nodes[node]
        own = part.tie(inner, dof)
        if own is None:
            return None
        row = np.zeros(self._count)
        row[place] = own
        return row

    def _position(self, node: str) -> FloatArray:
        part, inner, _ = self._nodes[node]
        return np.array(part.position(inner))

    @property
    def _tolerance(self) -> float:
        places = np.array([self._position(node) for node in self._nodes])
        return _ROUNDING * float(np.ptp(places, axis=0).max())


class _Groups:
    """Things that belong together."""

    def __init__(self) -> None:
        self._parent: dict[str, str] = {}

    def unite(self, first: str, second: str) -> bool:
        """Put the groups of two things together; tell whether they were apart."""
        one, other = self._root(first), self._root(second)
        self._parent[other] = one
        return one != other

    def _root(self, thing: str) -> str:
        while self._parent.setdefault(thing, thing) != thing:
            thing = self._parent[thing]
        return thing
