"""``[matrices]``: a model from files."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from bumpstop.arguments import did_you_mean
from bumpstop.errors import InputError
from bumpstop.io.case.keys import keyed
from bumpstop.io.matrices.read import MatrixSet, read_matrix_set
from bumpstop.structure.matrices import ACCURACY, Matrices

if TYPE_CHECKING:
    from bumpstop.io.case.tables.matrices import MatricesTable
    from bumpstop.io.case.tables.structure import StructureTables
    from bumpstop.io.case.tables.supports import SupportTable
    from bumpstop.structure.dofs import Dof

__all__ = ["built_matrices"]

_FILES = ("stiffness", "mass", "damping", "gyroscopic", "circulatory")


def built_matrices(tables: StructureTables, table: MatricesTable, folder: Path) -> Matrices:
    """Return the model that the files hold, with the supports of the tables."""
    names = {key: getattr(table, key) for key in _FILES}
    with keyed("matrices"):
        given = read_matrix_set(
            {key: folder / name for key, name in names.items() if name is not None},
            None if table.dofs is None else folder / table.dofs,
        ).in_si(length=table.length, force=table.force)
    fixed = [*_held(tables.supports, given)]
    with keyed("matrices"):
        return given.model(fixed=fixed, accuracy=table.accuracy or ACCURACY)


def _held(supports: Sequence[SupportTable], given: MatrixSet) -> Iterator[Dof]:
    """Yield what the supports hold; "all" means the nodes that have the dof."""
    known = set(given.dof_map.dofs)
    nodes = dict.fromkeys(node for node, _ in given.dof_map.dofs)
    for number, support in enumerate(supports):
        everywhere = support.nodes == ["all"]
        for node in nodes if everywhere else support.nodes:
            if node not in nodes:
                key, hint = f"supports.{number}.nodes", did_you_mean(node, nodes)
                raise InputError("unknown node", key=key, value=node, hint=hint)
            for dof in support.fixed:
                if (node, dof) in known:
                    yield node, dof
                elif not everywhere:
                    what = f"the matrices have no such dof at node {node!r}"
                    raise InputError(what, key=f"supports.{number}.fixed", value=dof)
