"""What ties dofs: supports, relations and rigid links."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop import structure
from bumpstop.io.case.keys import keyed
from bumpstop.structure.support import Support

if TYPE_CHECKING:
    from bumpstop.io.case.tables.structure import StructureTables
    from bumpstop.structure.link import RigidLink
    from bumpstop.structure.relation import Relation

__all__ = ["built_links", "built_relations", "built_supports"]


def built_supports(case: StructureTables) -> list[Support]:
    """Return the supports."""
    return [
        Support(nodes=_all_or(table.nodes), fixed=tuple(table.fixed)) for table in case.supports
    ]


def built_relations(case: StructureTables) -> list[Relation]:
    """Return the relations between dofs."""
    relations = []
    for number, table in enumerate(case.relations):
        with keyed(f"relations.{number}"):
            terms = {
                (node, dof): weight
                for node, weights in table.terms.items()
                for dof, weight in weights.items()
            }
            relations.append(structure.Relation(terms))
    return relations


def built_links(case: StructureTables) -> list[RigidLink]:
    """Return the rigid links."""
    links = []
    for name, table in case.links.items():
        with keyed(f"links.{name}"):
            links.append(structure.RigidLink(name, nodes=table.nodes, dofs=table.dofs))
    return links


def _all_or(nodes: list[str]) -> str | tuple[str, ...]:
    return "all" if nodes == ["all"] else tuple(nodes)
