"""``[mesh]``: the tables of a structure, from a mesh and what the case says of its groups."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bumpstop.errors import InputError
from bumpstop.io.case.build.structure import built_structure
from bumpstop.io.case.keys import dotted, keyed
from bumpstop.io.case.tables.beams import BeamTable
from bumpstop.io.meshes.read import read_mesh

if TYPE_CHECKING:
    from bumpstop.io.case.tables.case_file import CaseFile
    from bumpstop.io.case.tables.mesh import MeshTable
    from bumpstop.io.case.tables.supports import SupportTable
    from bumpstop.io.meshes.line_mesh import LineMesh
    from bumpstop.structure import Structure

__all__ = ["built_meshed"]


def built_meshed(case: CaseFile, table: MeshTable, folder: Path) -> Structure:
    """Return the structure whose beams stand on the lines of a mesh."""
    with keyed("mesh"):
        mesh = read_mesh(folder / table.file).scaled(table.unit)
    groups = _group_of_lines(mesh, table)
    beams = {
        line: BeamTable.unchecked(nodes=mesh.lines[line], **dict(table.beams[group]))
        for line, group in groups.items()
    }
    changes: dict[str, Any] = {
        "nodes": _used(mesh, beams),
        "beams": {**beams, **case.beams},
        "supports": [*_supports(mesh, case.supports)],
    }
    with _told_of_groups(groups), keyed():
        return built_structure(case.replaced(**changes))


def _group_of_lines(mesh: LineMesh, table: MeshTable) -> dict[str, str]:
    """Return the group, of those that the case names, of each line."""
    groups: dict[str, str] = {}
    for group in table.beams:
        key = dotted(("mesh", "beams", group))
        with keyed(renamed={"group": key}):
            lines = mesh.lines_of(group)
        for line in lines:
            if line in groups:
                raise InputError(f"line {line} is in group {groups[line]!r} too", key=key)
            groups[line] = group
    return groups


def _used(mesh: LineMesh, beams: Mapping[str, BeamTable]) -> dict[str, tuple[float, float, float]]:
    """Return the nodes at ends of beams, and those that have names of their own."""
    ends = {end for beam in beams.values() for end in beam.nodes}
    alone = {nodes[0] for nodes in mesh.node_groups.values() if len(nodes) == 1}
    return {node: place for node, place in mesh.nodes.items() if node in ends | alone}


def _supports(mesh: LineMesh, tables: Iterable[SupportTable]) -> Iterator[SupportTable]:
    """Yield the supports with nodes in the place of groups."""
    for number, table in enumerate(tables):
        if table.nodes == ["all"]:
            yield table
            continue
        with keyed(f"supports.{number}"):
            yield table.replaced(nodes=mesh.nodes_of(table.nodes))


@contextmanager
def _told_of_groups(groups: Mapping[str, str]) -> Iterator[None]:
    """Say of which group of the case a beam is, and not of which line."""
    try:
        yield
    except InputError as error:
        table, _, rest = (error.key or "").partition(".")
        line, point, key = rest.partition(".")
        if table != "beams" or line not in groups:
            raise
        place = dotted(("mesh", "beams", groups[line]))
        raise InputError(
            error.what, key=f"{place}{point}{key}", value=error.value, hint=error.hint
        ) from error
