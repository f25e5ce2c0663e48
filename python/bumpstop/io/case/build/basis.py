"""``[basis]`` and what it is computed from."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from bumpstop.errors import InputError
from bumpstop.io.case.build.names import named
from bumpstop.io.case.build.structure import built_structure
from bumpstop.io.case.keys import keyed
from bumpstop.modal.basis import ModalBasis

if TYPE_CHECKING:
    from bumpstop.io.case.tables.case_file import CaseFile
    from bumpstop.io.case.tables.stops import StopTable
    from bumpstop.structure.dofs import Place
    from bumpstop.structure.model import LinearModel

__all__ = ["built_basis", "built_model", "load_tables", "static_places"]


def built_basis(case: CaseFile, folder: Path) -> ModalBasis:
    """Return the modal basis of the case's structure, or of the files that it names."""
    if case.modes is not None:
        from bumpstop.io.case.build.modes import built_modes

        return built_modes(case, case.modes, folder)
    structure = built_model(case, folder)
    table = case.basis
    if table.model == "full":
        from bumpstop.modal.full import FullModel

        with keyed("basis"):
            return FullModel.from_structure(
                structure,
                damping=table.damping,
                mass=table.mass,
                rigid_modes=table.rigid_modes,
            )
    with keyed("basis"):
        if table.modes is None:
            hint = 'say how many modes, or model = "full"'
            raise InputError("is missing", key="modes", hint=hint)
        return ModalBasis.from_structure(
            structure,
            modes=table.modes,
            damping=table.damping,
            damping_coupling=table.damping_coupling,
            static_shapes=static_places(case),
            constraint_shapes=table.constraint_shapes,
            base_shapes=table.base_shapes,
            load_shapes=_loads(case, folder),
            static_damping=table.static_damping,
            rigid_modes=table.rigid_modes,
        )


def built_model(case: CaseFile, folder: Path) -> LinearModel:
    """Return what the modes are computed from; the case has no modes of its own."""
    if case.matrices is not None:
        from bumpstop.io.case.build.matrices import built_matrices

        return built_matrices(case, case.matrices, folder)
    if case.mesh is not None:
        from bumpstop.io.case.build.mesh import built_meshed

        return built_meshed(case, case.mesh, folder)
    if case.parts:
        from bumpstop.io.case.build.assembly import built_assembly

        return built_assembly(case, folder)
    with keyed():
        return built_structure(case)


def load_tables(case: CaseFile) -> dict[str, Any]:
    """Return the tables of the loads whose static shapes join the modes, by name."""
    wanted = case.basis.load_shapes
    if not wanted:
        return {}
    from bumpstop.io.case.build.loads import BASE_MOTION

    known: dict[str, Any] = dict(case.loads)
    if case.base_motion is not None:
        known[BASE_MOTION] = case.base_motion
    if isinstance(wanted, str):
        return known
    return {name: named("load_shapes", name, known) for name in wanted}


def _loads(case: CaseFile, folder: Path) -> list[Any]:
    wanted = load_tables(case)
    if not wanted:
        return []
    from bumpstop.io.case.build.loads import built_loads

    return [load for load in built_loads(case, folder) if load.name in wanted]


def static_places(case: CaseFile) -> list[Place]:
    """Return where unit forces act whose static shapes join the modes."""
    if isinstance(case.basis.static_shapes, str):
        return [place for stop in case.stops.values() for place in _stop_places(stop)]
    return case.basis.static_shapes


def _stop_places(stop: StopTable) -> list[Place]:
    """Return where a stop pushes; what it lacks is told when the stop is made."""
    if stop.terms is not None:
        return [(node, dof) for node, weights in stop.terms.items() for dof in weights]
    nodes = [node for node in (stop.node, *(stop.nodes or ()), stop.other) if node is not None]
    directions = [] if stop.normal is None else [stop.normal]
    if stop.axis is not None:
        from bumpstop.laws.around_axis import plane_axes

        first, second, _ = plane_axes(stop.axis, stop.roll or 0.0).tolist()
        directions = [tuple(first), tuple(second)]
    return [(node, direction) for node in nodes for direction in directions]
