"""From checked tables to the objects that are simulated: one file a part of the case."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from bumpstop.errors import InputError
from bumpstop.io.case.build.basis import built_basis, load_tables, static_places
from bumpstop.io.case.build.gauges import built_gauges
from bumpstop.io.case.build.initial import built_initial, run_loads, state_key
from bumpstop.io.case.build.laws import built_laws
from bumpstop.io.case.build.loads import BASE_MOTION, built_loads
from bumpstop.io.case.build.source import SOURCES, require_one_source
from bumpstop.io.case.keys import keyed
from bumpstop.io.case.tables.structure import StructureTables
from bumpstop.io.case.tables.table import keys_of
from bumpstop.problem import Problem

if TYPE_CHECKING:
    from bumpstop.io.case.tables.case_file import CaseFile
    from bumpstop.io.case.tables.run import RunTable
    from bumpstop.loads import ShaftRotation
    from bumpstop.modal.basis import ModalBasis

__all__ = ["STRUCTURE", "Builder"]

STRUCTURE = (*SOURCES, *keys_of(StructureTables), "components", "joints", "basis")
"""Tables that the modes are made of."""

_IN_TIME = (
    *("stops", "laws", "loads", "base_motion", "rotation", "initial"),
    *("gauges", "outputs", "results"),
)
"""Tables that mean nothing where nothing is simulated."""

_OF_TIME = {
    "time": "table",
    "time.formula": "expression",
    "time.factors": "product",
    "time.tolerance": "line_tolerance",
}
"""What a load's functions of time and their arguments are called in the file."""


class Builder:
    """Builds the problems of one case; variants of the same structure share its modes.

    Parameters
    ----------
    folder
        Where the case file is: paths in it are relative to that.
    known
        Tables whose modes are known already, with these modes.
    most
        Modes of the last so many structures are kept; of all where left out.
    """

    def __init__(
        self,
        folder: Path,
        *,
        known: Sequence[tuple[CaseFile, ModalBasis]] = (),
        most: int | None = None,
    ) -> None:
        self._folder = folder
        self._bases = list(known)
        self._most = most

    def variant(self, case: CaseFile) -> tuple[ModalBasis, Problem | None]:
        """Return the modes that the tables describe, and the problem where they have ``[run]``.

        Raises
        ------
        InputError
            As `problem` does.
        """
        if case.run is not None:
            problem = self.problem(case, case.run)
            return problem.basis, problem
        for part in _IN_TIME:
            if getattr(case, part):
                what = f"is missing, and there are {part}"
                hint = "say how long to simulate; modes alone need none of these"
                raise InputError(what, key="run", hint=hint)
        return self.basis(case), None

    def problem(self, case: CaseFile, run: RunTable) -> Problem:
        """Return the problem that the tables describe, for as long as `run` says.

        Raises
        ------
        InputError
            If something named is not there or numbers do not fit together; its key is that
            of the file.
        """
        basis = self.basis(case)
        laws, loads = built_laws(case, self._folder), built_loads(case, self._folder)
        initial, loads = built_initial(case.initial, laws, loads), run_loads(case.initial, loads)
        with keyed(renamed=_renamed(case)):
            return Problem(
                basis,
                laws=laws,
                loads=loads,
                initial=initial,
                duration=run.duration,
                sample=run.sample,
                gauges=built_gauges(case),
                outputs=[(output.node, output.dof) for output in case.outputs],
                rotation=_rotation(case, self._folder),
            )

    def basis(self, case: CaseFile) -> ModalBasis:
        """Return the modes that the tables describe.

        Raises
        ------
        InputError
            As `problem` does.
        """
        for known, basis in self._bases:
            if _same_basis(known, case):
                return basis
        require_one_source(case, STRUCTURE)
        basis = built_basis(case, self._folder)
        self._bases.append((case, basis))
        if self._most is not None:
            del self._bases[: -self._most]
        return basis


def _same_basis(one: CaseFile, other: CaseFile) -> bool:
    same = all(getattr(one, table) == getattr(other, table) for table in STRUCTURE)
    same = same and static_places(one) == static_places(other)
    return same and load_tables(one) == load_tables(other)


def _functions(load: str, table: str) -> dict[str, str]:
    """Return what the functions of time of a load, and their arguments, are called in its table."""
    return {f"{load}.{argument}": f"{table}.{key}" for argument, key in _OF_TIME.items()}


def _rotation(case: CaseFile, folder: Path) -> ShaftRotation | None:
    """Return how the shafts turn; most do not."""
    if case.rotation is None:
        return None
    from bumpstop.io.case.build.rotation import built_rotation

    return built_rotation(case, folder)


def _renamed(case: CaseFile) -> dict[str, str]:
    """Return where in the file the arguments of a problem stand."""
    tables: dict[str, str] = {}
    for name in case.loads:
        tables |= _functions(f"loads.{name}", f"loads.{name}")
    if case.base_motion is not None:
        place = f"loads.{BASE_MOTION}"
        tables |= {place: BASE_MOTION} | _functions(place, BASE_MOTION)
    return tables | {
        "duration": "run.duration",
        "sample": "run.sample",
        "initial": state_key(case.initial),
    }
