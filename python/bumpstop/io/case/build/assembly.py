"""``[components]``, ``[parts]`` and ``[[joints]]``: an assembly."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from bumpstop.errors import InputError
from bumpstop.io.case.build.constraints import built_supports
from bumpstop.io.case.build.names import named
from bumpstop.io.case.build.structure import built_structure
from bumpstop.io.case.keys import keyed
from bumpstop.modal.substructure import (
    Assembly,
    Component,
    Joint,
    Placed,
    ReducedComponent,
    Rotation,
    craig_bampton,
    free_interface,
)

if TYPE_CHECKING:
    from bumpstop.io.case.tables.case_file import CaseFile
    from bumpstop.io.case.tables.components import ComponentTable
    from bumpstop.io.case.tables.parts import PartTable
    from bumpstop.structure.model import LinearModel

__all__ = ["built_assembly"]

_REDUCTIONS = {"craig_bampton": craig_bampton, "free_interface": free_interface}
_SHARED = ("materials", "sections")
"""Tables of the case that all its components can use."""


def built_assembly(case: CaseFile, folder: Path) -> Assembly:
    """Return the assembly that the tables describe."""
    components = {
        name: _component(name, table, case, folder) for name, table in case.components.items()
    }
    parts = {}
    for name, part in case.parts.items():
        with keyed(f"parts.{name}"):
            component = named("component", part.component, components)
            parts[name] = Placed(component, at=part.at, rotation=_rotation(part))
    joints = []
    for number, joint in enumerate(case.joints):
        with keyed(f"joints.{number}", renamed={"": "nodes"}):
            joints.append(Joint(*joint.nodes, dofs=joint.dofs))
    with keyed():
        return Assembly(parts=parts, joints=joints, supports=built_supports(case))


def _component(name: str, table: ComponentTable, case: CaseFile, folder: Path) -> ReducedComponent:
    with _of_component(name, table):
        component = Component(_model(table, case, folder), interface=table.interface)
        return _REDUCTIONS[table.reduction](component, modes=table.modes)


def _model(table: ComponentTable, case: CaseFile, folder: Path) -> LinearModel:
    if bool(table.nodes) == (table.matrices is not None):
        what = "nodes and matrices exclude each other" if table.nodes else "is missing"
        raise InputError(what, key="nodes", hint="give nodes, matrices or a file")
    if table.matrices is not None:
        from bumpstop.io.case.build.matrices import built_matrices

        return built_matrices(table, table.matrices, folder)
    shared = {kind: {**getattr(case, kind), **getattr(table, kind)} for kind in _SHARED}
    return built_structure(table.replaced(**shared))


def _rotation(part: PartTable) -> Rotation | None:
    if part.rotation is None:
        return None
    with keyed("rotation"):
        return Rotation(axis=part.rotation.axis, angle=part.rotation.angle)


@contextmanager
def _of_component(name: str, table: ComponentTable) -> Iterator[None]:
    """Say which component a key belongs to, unless it is one that the whole case shares."""
    try:
        with keyed():
            yield
    except InputError as error:
        kind, _, rest = (error.key or "").partition(".")
        if error.file or (kind in _SHARED and rest.partition(".")[0] not in getattr(table, kind)):
            raise
        key = f"components.{name}.{error.key}" if error.key else f"components.{name}"
        raise InputError(error.what, key=key, value=error.value, hint=error.hint) from error
