"""Gmsh meshes (.msh), versions 2.2 and 4.1 in text form.

Format: Gmsh reference manual, "Gmsh file formats". Physical curves and points become groups.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple, Protocol, TypeAlias

from bumpstop.arguments import Vector
from bumpstop.errors import InputError
from bumpstop.io.meshes.line_mesh import LineMesh, line_mesh
from bumpstop.io.reading import in_file, read_lines

__all__ = ["read_gmsh"]

_LINE, _POINT = 1, 15
_CURVED = (8, 26, 27, 28)
"""Lines with nodes between their ends."""

_Sections: TypeAlias = dict[str, list[str]]
"""The lines of each section by its name."""


def read_gmsh(path: Path) -> LineMesh:
    """Read the lines of a Gmsh mesh. Nodes and lines are called by their tags.

    Raises
    ------
    InputError
        If the file cannot be read, is binary or truncated, or of another version.
    """
    with in_file(path):
        sections = _sections(read_lines(path, "a Gmsh mesh in text form"))
        version = sections.get("MeshFormat", [""])[0].split()
        if len(version) != 3 or version[0] not in _VERSIONS:
            hint = "export it as version 4.1 or 2.2"
            raise InputError("is of no known version of Gmsh", value=" ".join(version), hint=hint)
        if version[1] != "0":
            raise InputError("is binary", hint="export it as ASCII")
        for section in ("Nodes", "Elements"):
            if section not in sections:
                raise InputError(f"has no ${section}")
        try:
            return _mesh(_VERSIONS[version[0]], sections)
        except InputError:
            raise
        except (ValueError, IndexError, StopIteration, RuntimeError) as error:
            raise InputError("a number is missing or cannot be read") from error


def _sections(lines: list[str]) -> _Sections:
    """Return the lines of each section by its name."""
    sections: _Sections = {}
    name = ""
    for line in lines:
        if line.startswith("$End"):
            name = ""
        elif line.startswith("$"):
            name = line[1:].strip()
            sections[name] = []
        elif name and line:
            sections[name].append(line)
    if name:
        raise InputError(f"is truncated within ${name}")
    if not sections:
        raise InputError("is not a Gmsh mesh: it has no sections")
    if not all(sections.values()):
        raise InputError("has an empty section")
    return sections


class _Node(NamedTuple):
    tag: str
    place: list[str]


class _Element(NamedTuple):
    tag: str
    kind: int
    nodes: list[str]
    physical: list[int]
    """Tags of the physical groups that it belongs to."""


class _Version(Protocol):
    """How a version of the format writes nodes and elements."""

    def nodes(self, sections: _Sections) -> Iterator[_Node]:
        """Yield each node."""

    def elements(self, sections: _Sections) -> Iterator[_Element]:
        """Yield each element."""


def _mesh(version: _Version, sections: _Sections) -> LineMesh:
    parts = _Parts(_physical_names(sections.get("PhysicalNames", ["0"])))
    for node in version.nodes(sections):
        parts.add_node(*node)
    for element in version.elements(sections):
        parts.add_element(*element)
    return line_mesh(parts.nodes, parts.lines, parts.line_groups, parts.node_groups)


class _Parts:
    """Nodes, lines and points, with the groups they are in."""

    def __init__(self, names: dict[tuple[int, int], str]) -> None:
        self.groups = names
        self.nodes: dict[str, Vector] = {}
        self.lines: dict[str, tuple[str, str]] = {}
        self.line_groups: dict[str, list[str]] = {}
        self.node_groups: dict[str, list[str]] = {}

    def add_node(self, tag: str, place: list[str]) -> None:
        """Add a node with its coordinates."""
        if tag in self.nodes:
            raise InputError(f"node {tag} is there twice")
        x, y, z = (float(word) for word in place[:3])
        self.nodes[tag] = (x, y, z)

    def add_element(self, tag: str, kind: int, nodes: list[str], physical: list[int]) -> None:
        """Add an element, if it is a line or a point."""
        if kind in _CURVED:
            what = f"line {tag} has nodes between its ends"
            raise InputError(what, hint="mesh with elements of first order")
        if kind == _LINE:
            first, last = nodes
            if tag in self.lines:
                raise InputError(f"line {tag} is there twice")
            self.lines[tag] = (first, last)
            self._join(self.line_groups, 1, tag, physical)
        elif kind == _POINT:
            self._join(self.node_groups, 0, nodes[0], physical)

    def _join(
        self, groups: dict[str, list[str]], dimension: int, name: str, physical: list[int]
    ) -> None:
        for tag in physical:
            group = self.groups.get((dimension, abs(tag)), str(abs(tag)))
            groups.setdefault(group, []).append(name)


def _physical_names(lines: list[str]) -> dict[tuple[int, int], str]:
    """Return the name of each physical group by its dimension and tag."""
    names = {}
    for line in lines[1:]:
        dimension, tag, name = line.split(maxsplit=2)
        names[int(dimension), int(tag)] = name.strip().strip('"')
    return names


class _Version2:
    def nodes(self, sections: _Sections) -> Iterator[_Node]:
        """Yield each node."""
        lines = iter(sections["Nodes"])
        for _ in range(_announced(next(lines), sections["Nodes"])):
            tag, *place = next(lines).split()
            yield _Node(tag, place)

    def elements(self, sections: _Sections) -> Iterator[_Element]:
        """Yield each element."""
        lines = iter(sections["Elements"])
        for _ in range(_announced(next(lines), sections["Elements"])):
            tag, *words = next(lines).split()
            kind, tags = int(words[0]), int(words[1])
            physical = [int(word) for word in words[2:3] if tags and word != "0"]
            yield _Element(tag, kind, words[2 + tags :], physical)


class _Version4:
    def nodes(self, sections: _Sections) -> Iterator[_Node]:
        """Yield each node."""
        lines = iter(sections["Nodes"])
        for _ in range(_announced(next(lines).split()[0], sections["Nodes"])):
            count = _announced(next(lines).split()[3], sections["Nodes"])
            for tag in [next(lines).strip() for _ in range(count)]:
                yield _Node(tag, next(lines).split())

    def elements(self, sections: _Sections) -> Iterator[_Element]:
        """Yield each element."""
        groups = _physical_of_entities(iter(sections.get("Entities", ["0 0 0 0"])))
        lines = iter(sections["Elements"])
        for _ in range(_announced(next(lines).split()[0], sections["Elements"])):
            dimension, entity, kind, count = next(lines).split()
            physical = groups.get((int(dimension), int(entity)), [])
            for _ in range(_announced(count, sections["Elements"])):
                tag, *nodes = next(lines).split()
                yield _Element(tag, int(kind), nodes, physical)


def _physical_of_entities(lines: Iterator[str]) -> dict[tuple[int, int], list[int]]:
    """Return the tags of the physical groups of each point and curve."""
    counts = [int(word) for word in next(lines).split()]
    physical = {}
    for dimension, place in ((0, 4), (1, 7)):  # after the tag and its coordinates or box
        for _ in range(counts[dimension]):
            words = next(lines).split()
            count = int(words[place])
            tags = [int(word) for word in words[place + 1 : place + 1 + count]]
            physical[dimension, int(words[0])] = tags
    return physical


def _announced(word: str, section: list[str]) -> int:
    """Return a number of things; InputError where the section has fewer lines than that."""
    count = int(word)
    if count > len(section):
        raise InputError(f"announces {count} nodes or elements and has fewer", hint="truncated?")
    return count


_VERSIONS: dict[str, _Version] = {"2.2": _Version2(), "4.1": _Version4()}
