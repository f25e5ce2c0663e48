"""Nodes, beams and masses."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from bumpstop.io.case.build.constraints import built_links, built_relations, built_supports
from bumpstop.io.case.build.names import named
from bumpstop.io.case.keys import keyed
from bumpstop.structure import Beam, Material, PointMass, Rectangle, Structure

if TYPE_CHECKING:
    from bumpstop.io.case.tables.beams import BeamTable
    from bumpstop.io.case.tables.structure import StructureTables

__all__ = ["built_structure"]


def built_structure(case: StructureTables) -> Structure:
    """Return the structure that the tables describe."""
    return Structure(
        nodes=case.nodes,
        beams=_beams(case),
        masses=[
            PointMass(name, node=table.node, mass=table.mass) for name, table in case.masses.items()
        ],
        supports=built_supports(case),
        relations=built_relations(case),
        links=built_links(case),
    )


def _beams(case: StructureTables) -> list[Beam]:
    materials, sections = {}, {}
    for name, material in case.materials.items():
        with keyed(f"materials.{name}"):
            materials[name] = Material(**dict(material))
    for name, section in case.sections.items():
        with keyed(f"sections.{name}"):
            sections[name] = Rectangle(height=section.height, width=section.width)
    return [_beam(name, table, materials, sections) for name, table in case.beams.items()]


def _beam(
    name: str,
    table: BeamTable,
    materials: Mapping[str, Material],
    sections: Mapping[str, Rectangle],
) -> Beam:
    with keyed(f"beams.{name}"):
        return Beam(
            name,
            nodes=table.nodes,
            elements=table.elements,
            theory=table.theory,
            material=named("material", table.material, materials),
            section=named("section", table.section, sections),
        )
