"""LineMesh: nodes, lines between two of them, and groups of both."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TypedDict, Unpack

from bumpstop.arguments import Vector, did_you_mean
from bumpstop.errors import InputError
from bumpstop.structure.beam import Beam
from bumpstop.structure.material import Material
from bumpstop.structure.sections.section import Section

__all__ = ["LineMesh", "line_mesh"]


class BeamProperties(TypedDict, total=False):
    """What beams of a group have in common: arguments of ``Beam``."""

    material: Material
    section: Section
    elements: int
    theory: str
    roll: float
    mass: str
    added_mass: float
    tension: float
    spin: float


@dataclass(frozen=True, eq=False)
class LineMesh:
    """The lines of a mesh, from which beams are made.

    Parameters
    ----------
    nodes
        Coordinates (x, y, z) of each node, as the file has them; their unit is the file's. A
        node that is alone in a group has the group's name.
    lines
        Names of the two ends of each line.
    line_groups, node_groups
        Names of the lines and of the nodes in each group.
    """

    nodes: Mapping[str, Vector]
    lines: Mapping[str, tuple[str, str]]
    line_groups: Mapping[str, tuple[str, ...]]
    node_groups: Mapping[str, tuple[str, ...]]

    def beams(self, group: str, **properties: Unpack[BeamProperties]) -> list[Beam]:
        """Return a beam for each line of a group, called like the line.

        Parameters
        ----------
        group
            Name of a group of lines.
        properties
            Arguments of ``Beam``, the same for all; ``elements`` is 1 where left out.

        Raises
        ------
        InputError
            If there is no such group, or a property cannot be used.
        """
        arguments: BeamProperties = {"elements": 1, **properties}
        return [Beam(line, nodes=self.lines[line], **arguments) for line in self.lines_of(group)]

    def lines_of(self, group: str) -> tuple[str, ...]:
        """Return the lines of a group.

        Raises
        ------
        InputError
            If there is no such group.
        """
        if group not in self.line_groups:
            hint = did_you_mean(group, self.line_groups)
            raise InputError("unknown group of lines", key="group", value=group, hint=hint)
        return self.line_groups[group]

    def nodes_of(self, names: Iterable[str]) -> list[str]:
        """Return nodes by their own names and those of groups, each once.

        Raises
        ------
        InputError
            If there is no such node or group.
        """
        found: dict[str, None] = {}
        for name in names:
            if name not in self.nodes and name not in self.node_groups:
                hint = did_you_mean(name, [*self.nodes, *self.node_groups])
                raise InputError("unknown node or group", key="nodes", value=name, hint=hint)
            found.update(dict.fromkeys(self.node_groups.get(name, (name,))))
        return list(found)

    def scaled(self, factor: float) -> LineMesh:
        """Return the mesh with all coordinates multiplied: 1e-3 brings millimetres to metres."""
        nodes = {
            name: (factor * x, factor * y, factor * z) for name, (x, y, z) in self.nodes.items()
        }
        return LineMesh(nodes, self.lines, self.line_groups, self.node_groups)


def line_mesh(
    nodes: Mapping[str, Vector],
    lines: Mapping[str, tuple[str, str]],
    line_groups: Mapping[str, Iterable[str]],
    node_groups: Mapping[str, Iterable[str]],
) -> LineMesh:
    """Return the mesh of what a file holds, without nodes that neither lines nor groups use.

    Raises
    ------
    InputError
        If a coordinate is not finite, a line ends at an unknown node or has no length, a group
        holds what is not there, or there is no line.
    """
    if not lines:
        raise InputError("has no lines between two nodes", hint="beams are made of such lines")
    for name, place in nodes.items():
        if not all(map(math.isfinite, place)):
            raise InputError(f"a coordinate of node {name} is not finite", value=place)
    for name, ends in lines.items():
        for end in ends:
            if end not in nodes:
                raise InputError(f"line {name} ends at node {end}, which is not there")
        if nodes[ends[0]] == nodes[ends[1]]:
            raise InputError(f"line {name} has no length")
    _check_groups("lines", line_groups, lines)
    _check_groups("nodes", node_groups, nodes)
    names = _called_by_group(nodes, node_groups)
    used = {end for ends in lines.values() for end in ends}
    used.update(node for group in node_groups.values() for node in group)
    return LineMesh(
        nodes={names[node]: place for node, place in nodes.items() if node in used},
        lines={name: (names[first], names[last]) for name, (first, last) in lines.items()},
        line_groups={group: tuple(dict.fromkeys(held)) for group, held in line_groups.items()},
        node_groups={
            group: tuple(dict.fromkeys(names[node] for node in held))
            for group, held in node_groups.items()
        },
    )


def _check_groups(
    things: str, groups: Mapping[str, Iterable[str]], known: Mapping[str, object]
) -> None:
    for group, held in groups.items():
        for name in held:
            if name not in known:
                raise InputError(f"group {group!r} of {things} holds {name}, which is not there")


def _called_by_group(
    nodes: Mapping[str, Vector], groups: Mapping[str, Iterable[str]]
) -> dict[str, str]:
    """Return what each node is called: by its group where it is alone in one."""
    names = {node: node for node in nodes}
    for group, held in groups.items():
        alone = list(dict.fromkeys(held))
        if len(alone) == 1 and names[alone[0]] == alone[0] and group not in names.values():
            names[alone[0]] = group
    return names
