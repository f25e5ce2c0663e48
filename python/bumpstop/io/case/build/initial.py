"""The state at the start."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop import loads
from bumpstop.errors import InputError
from bumpstop.io.case.build.names import named
from bumpstop.io.case.keys import keyed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bumpstop.io.case.tables.initial import InitialTable
    from bumpstop.problem import InitialState, Law, Load

__all__ = ["built_initial", "run_loads", "state_key"]


def built_initial(
    table: InitialTable | None, laws: Sequence[Law], loads_: Sequence[Load]
) -> InitialState | None:
    """Return the initial state that the table describes; None for rest.

    Parameters
    ----------
    table
        The table.
    laws, loads_
        All of the case, for an equilibrium under them.
    """
    if table is None:
        return None
    with keyed("initial"):
        given = _given(table)
        if not given:
            raise InputError("is empty", hint="give one of its keys, or leave [initial] out")
        if len(given) > 1:
            what = f"{' and '.join(given)} exclude each other"
            raise InputError(what, hint="give one of them")
        if table.rotation:
            return loads.RigidRotation(about=table.rotation.about, rate=table.rotation.rate)
        if table.translation:
            moving = table.translation
            return loads.RigidTranslation(moving.velocity, nodes=moving.nodes, beams=moving.beams)
        if table.static:
            with keyed("static"):
                names = _named_loads("loads", table.static.loads, loads_)
                holding = [load for load in loads_ if load.name in names]
                return loads.StaticState(loads=holding, laws=laws)
        if table.nodal:
            return loads.NodalState(**{key: _by_dof(values) for key, values in table.nodal})
        return loads.ModalState(**dict(table.modal or ()))


def run_loads(table: InitialTable | None, loads_: Sequence[Load]) -> list[Load]:
    """Return the loads that do not let go at t = 0."""
    if table is None or table.static is None or not table.static.release:
        return list(loads_)
    with keyed("initial.static"):
        released = _named_loads("release", table.static.release, loads_)
    return [load for load in loads_ if load.name not in released]


def _named_loads(key: str, wanted: Sequence[str] | str, known: Sequence[Load]) -> set[str]:
    """Return the names of the loads that are meant."""
    by_name = {load.name: load for load in known}
    if isinstance(wanted, str):
        return set(by_name)
    for name in wanted:
        named(key, name, by_name)
    return set(wanted)


def _by_dof(values: dict[str, dict[str, float]] | None) -> dict[tuple[str, str], float] | None:
    if values is None:
        return None
    return {(node, dof): value for node, each in values.items() for dof, value in each.items()}


def state_key(table: InitialTable | None) -> str:
    """Return where in the file the initial state stands."""
    return ".".join(["initial", *(_given(table) if table else ())])


def _given(table: InitialTable) -> list[str]:
    return [key for key, state in table if state is not None]
