"""From the values of the parameters to what is kept of a run.

What the swept parameters do not touch is read, checked and made once: the tables of the case,
and its modes. Modes that do depend on them are kept for a while, for the next runs of the same
structure.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING, Any

import numpy as np

from bumpstop.continued import end_state, started_from
from bumpstop.errors import BumpstopError, InputError, ModellingWarning
from bumpstop.io.case.build import Builder
from bumpstop.io.case.build.initial import built_initial
from bumpstop.io.case.load import checked_tables, method_of
from bumpstop.io.case.overrides import overridden
from bumpstop.methods import usable_options
from bumpstop.simulate import simulate
from bumpstop.study.core_runs import CoreRuns, swept_in_core
from bumpstop.study.outputs import Output
from bumpstop.study.parameters import Level

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.io.case.tables.case_file import CaseFile
    from bumpstop.io.case.tables.run import RunTable
    from bumpstop.modal.basis import ModalBasis
    from bumpstop.problem import Problem
    from bumpstop.response import Response

__all__ = ["FAILED", "GOOD", "Evaluator", "Kept", "Recipe", "simulated", "told_failure"]

GOOD = 1
FAILED = 2
"""How a run ended; 0 is one that has not been made."""

MOST_BASES = 8
"""Modes of as many structures are kept."""


@dataclass(frozen=True, kw_only=True)
class Recipe:
    """All that it takes to make the runs of a study, in this process or another.

    Parameters
    ----------
    document
        What the case file says of the variant, as TOML has it.
    folder
        Where the case file is.
    names
        Dotted names of the keys that vary.
    outputs
        What is kept of each run.
    known
        Tables whose modes are known already, with these modes.
    """

    document: dict[str, Any]
    folder: Path
    names: tuple[str, ...]
    outputs: Mapping[str, Output]
    known: tuple[tuple[CaseFile, ModalBasis], ...] = ()


@dataclass(frozen=True)
class Kept:
    """What is kept of some runs, one after the other.

    Parameters
    ----------
    values
        Of each output, (run, ...); NaN where the run failed.
    status
        `GOOD` or `FAILED`, (run,).
    messages
        Why a run failed; empty for the others.
    """

    values: dict[str, FloatArray]
    status: np.ndarray[Any, np.dtype[np.uint8]]
    messages: list[str] = field(default_factory=list)

    @classmethod
    def failed(cls, outputs: Mapping[str, Output], messages: Sequence[str]) -> Kept:
        """Return what is kept of runs that all failed."""
        number = len(messages)
        values = {name: np.full((number, *each.shape), np.nan) for name, each in outputs.items()}
        return cls(values, np.full(number, FAILED, np.uint8), list(messages))

    @classmethod
    def joined(cls, parts: Sequence[Kept]) -> Kept:
        """Return what is kept of several lots of runs, one after the other."""
        names = parts[0].values
        return cls(
            {name: np.concatenate([part.values[name] for part in parts]) for name in names},
            np.concatenate([part.status for part in parts]),
            [message for part in parts for message in part.messages],
        )

    def put(self, number: int, other: Kept) -> None:
        """Take over the only run of another, as the one of this number."""
        for name, values in other.values.items():
            self.values[name][number] = values[0]
        self.status[number] = other.status[0]
        self.messages[number] = other.messages[0]


class Evaluator:
    """Makes the runs of a study, in the core where it can; several threads may ask for some."""

    def __init__(self, recipe: Recipe) -> None:
        self._recipe = recipe
        self._builder = Builder(recipe.folder, known=recipe.known, most=MOST_BASES)
        self._base = checked_tables(recipe.document)
        # What the checks of a whole file need beside the tables that vary.
        self._swept = {name.partition(".")[0] for name in recipe.names}
        needed = {*self._swept, "basis"}
        self._part = {key: each for key, each in recipe.document.items() if key in needed}
        self._lock = Lock()  # of the builder
        self._core: CoreRuns | None = None
        self._asks_core = swept_in_core(recipe.names) and self._base.run is not None

    def kept(self, columns: Mapping[str, Sequence[Level]]) -> Kept:
        """Return what is kept of the runs with these values of the parameters.

        A run that fails does not keep the others from being made.
        """
        number = len(next(iter(columns.values())))
        found = Kept.failed(self._recipe.outputs, [""] * number)
        left: Sequence[int] = range(number)
        core = self._core_runs(columns)
        if core is not None:
            shapes = {name: each.shape for name, each in self._recipe.outputs.items()}
            made = core.made(columns, shapes, self._state)
            found.values.update(made.values)
            found.status[made.good] = GOOD
            left = np.flatnonzero(~made.good).tolist()
        if left:
            with self._lock, warnings.catch_warnings():
                warnings.simplefilter("ignore", ModellingWarning)  # a line a run helps nobody
                self._make(columns, left, found)
        return found

    def runs_in_core(self, columns: Mapping[str, Sequence[Level]]) -> bool:
        """Tell whether the core makes such runs: then threads make them, and no processes."""
        plain = all(np.asarray(levels).dtype.kind in "iuf" for levels in columns.values())
        return plain and self._core_runs(columns) is not None

    def _make(
        self, columns: Mapping[str, Sequence[Level]], runs: Sequence[int], found: Kept
    ) -> None:
        """Make some of the runs one by one."""
        for run in runs:
            try:
                values = self._values({name: column[run] for name, column in columns.items()})
            except Exception as error:  # also a mistake of ours: the other runs go on
                found.messages[run] = told_failure(error)
                continue
            for name, value in values.items():
                found.values[name][run] = value
            found.status[run] = GOOD

    def _core_runs(self, columns: Mapping[str, Sequence[Level]]) -> CoreRuns | None:
        """Return what makes runs in the core; None where it cannot, or none of these are sound."""
        if not self._asks_core:
            return None
        with self._lock, np.errstate(over="raise", invalid="raise", divide="raise"):
            number = len(next(iter(columns.values())))
            for run in range(number if self._core is None else 0):
                try:
                    changes = {name: column[run] for name, column in columns.items()}
                    _, problem, tables = self.built(changes)
                    if problem is None or tables.run is None:
                        continue
                    if tables.initial is None or tables.initial.static is None:
                        method = method_of(tables.run).name
                        self._core = CoreRuns.of(problem, method, self._recipe.outputs)
                except (BumpstopError, ArithmeticError):
                    continue
                self._asks_core = self._core is not None
                break
            return self._core

    def _state(self, changes: Mapping[str, Level]) -> tuple[FloatArray, FloatArray]:
        """Return the modal state at the start, for other values in the table of it."""
        with self._lock, np.errstate(over="raise", invalid="raise", divide="raise"):
            tables = checked_tables(overridden(self._part, dict(changes)))
            initial = built_initial(tables.initial, (), ())
            assert initial is not None
            return initial.modal_state(self._builder.basis(self._base))

    def built(self, changes: Mapping[str, Level]) -> tuple[ModalBasis, Problem | None, CaseFile]:
        """Return modes and problem of a run, and the tables that they are made of.

        Raises
        ------
        InputError
            If a value cannot be used.
        """
        changed = checked_tables(overridden(self._part, dict(changes)))
        tables = self._base.replaced(**{key: getattr(changed, key) for key in self._swept})
        return (*self._builder.variant(tables), tables)

    def followed(
        self, changes: Mapping[str, Level], state: FloatArray
    ) -> tuple[dict[str, float | FloatArray], FloatArray]:
        """Make a run from a state; return what is kept of it, and the state in which it ends.

        Parameters
        ----------
        changes
            Values of the parameters.
        state
            Displacement and velocity of the modes, (2, U); NaN to start as the case does.

        Raises
        ------
        BumpstopError
            If the run fails, or another cannot go on from its end; see `end_state`.
        """
        with warnings.catch_warnings(), np.errstate(over="raise", invalid="raise", divide="raise"):
            warnings.simplefilter("ignore", ModellingWarning)
            _, problem, tables = self.built(changes)
            assert problem is not None
            assert tables.run is not None
            if not np.isnan(state).any():
                problem = started_from(problem, state)
            response = simulated(problem, tables.run)
            values = {name: output.value(response) for name, output in self._recipe.outputs.items()}
            return values, end_state(response)

    def _values(self, changes: Mapping[str, Level]) -> dict[str, float | FloatArray]:
        with np.errstate(over="raise", invalid="raise", divide="raise"):
            basis, problem, tables = self.built(changes)
            outputs = self._recipe.outputs
            if problem is None or tables.run is None:
                return {name: output.of_modes(basis) for name, output in outputs.items()}
            response = simulated(problem, tables.run)
            return {name: output.value(response) for name, output in outputs.items()}


def simulated(problem: Problem, run: RunTable) -> Response:
    """Return the response of a problem, integrated as its case says."""
    method, options = method_of(run)
    return simulate(problem, method, **usable_options(method, options, problem))


def told_failure(error: Exception) -> str:
    """Return in a line why a run failed."""
    if isinstance(error, InputError):
        return str(InputError(error.what, key=error.key, value=error.value, hint=error.hint))
    if isinstance(error, BumpstopError):
        return str(error)
    if isinstance(error, FloatingPointError | OverflowError):
        return "numbers grew too large or too small to compute with"
    if isinstance(error, MemoryError):
        return "not enough memory"
    return f"this is a mistake in bumpstop itself: {type(error).__name__}: {error}"
