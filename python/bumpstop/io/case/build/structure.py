"""Nodes, beams, masses, springs and bearings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from bumpstop import structure
from bumpstop.io.case.build.constraints import built_links, built_relations, built_supports
from bumpstop.io.case.build.names import named
from bumpstop.io.case.build.sections import section_of
from bumpstop.io.case.keys import keyed
from bumpstop.structure.beam import Beam
from bumpstop.structure.material import Material
from bumpstop.structure.structure import Structure

if TYPE_CHECKING:
    from bumpstop.io.case.tables.beams import BeamTable
    from bumpstop.io.case.tables.sections import SectionTable
    from bumpstop.io.case.tables.structure import StructureTables
    from bumpstop.io.case.tables.table import Table

__all__ = ["built_structure"]

_CLASSES = {"masses": "PointMass", "springs": "Spring", "bearings": "Bearing"}
"""What parts are made of whose arguments are called as the keys of their tables."""


def built_structure(case: StructureTables) -> Structure:
    """Return the structure that the tables describe."""
    return Structure(
        nodes=case.nodes,
        beams=_beams(case),
        masses=_parts("masses", case.masses),
        springs=_parts("springs", case.springs),
        bearings=_parts("bearings", case.bearings),
        supports=built_supports(case),
        relations=built_relations(case),
        links=built_links(case),
    )


def _parts(kind: str, tables: Mapping[str, Table]) -> list[Any]:
    """Return the parts of a kind; its class is loaded with the first of them."""
    parts = []
    for name, table in tables.items():
        with keyed(f"{kind}.{name}"):
            parts.append(getattr(structure, _CLASSES[kind])(name, **dict(table)))
    return parts


def _beams(case: StructureTables) -> list[Beam]:
    materials = {}
    for name, material in case.materials.items():
        with keyed(f"materials.{name}"):
            materials[name] = Material(**dict(material))
    for name, section in case.sections.items():
        with keyed(f"sections.{name}"):
            section_of(section, poisson_ratio=0.0)  # also what no beam has must be right
    return [_beam(name, table, materials, case.sections) for name, table in case.beams.items()]


def _beam(
    name: str,
    table: BeamTable,
    materials: Mapping[str, Material],
    sections: Mapping[str, SectionTable],
) -> Beam:
    with keyed(f"beams.{name}"):
        said: dict[str, Any] = dict(table)
        material = named("material", said.pop("material"), materials)
        for key in ("section", "end_section"):
            if said[key] is not None:
                section = named(key, said[key], sections)
                said[key] = section_of(section, poisson_ratio=material.poisson_ratio)
        return Beam(name, material=material, **said)
