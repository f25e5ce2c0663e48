"""Runs that the core makes by itself: what varies are numbers of stops, and where they start.

Each run gives the same bits as by way of a problem and a response in Python, without the
milliseconds that it takes to make these.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from bumpstop import _core
from bumpstop.canonical import CanonicalForm, canonical_form
from bumpstop.errors import BumpstopError
from bumpstop.methods import changing_speed
from bumpstop.scale import stiffest, too_stiff
from bumpstop.simulate import LARGEST_RESIDUAL, MOST_ENERGY
from bumpstop.study.core_outputs import core_quantities

if TYPE_CHECKING:
    from bumpstop.arguments import FloatArray
    from bumpstop.problem import Problem
    from bumpstop.study.outputs import Output
    from bumpstop.study.parameters import Level

__all__ = ["CoreRuns", "Made", "swept_in_core"]

STOP_NUMBERS = ("gap", "stiffness", "damping")
"""Numbers of a stop that the core varies."""
_POSITIVE = ("stiffness",)
_NOT_NEGATIVE = ("damping",)

Columns = Mapping[str, "Sequence[Level]"]
State = tuple["FloatArray", "FloatArray"]


class Made(NamedTuple):
    """Runs that the core has made."""

    values: dict[str, FloatArray]
    """Of each output, (run, ...)."""
    good: np.ndarray[tuple[int], np.dtype[np.bool_]]
    """Which runs it has made; the others are left to Python, which tells what is wrong."""


def swept_in_core(names: Sequence[str]) -> bool:
    """Tell whether keys of a case are such that the core may vary them."""
    return all(_stop_number(name) is not None or _is_of_start(name) for name in names)


def _stop_number(name: str) -> tuple[str, str] | None:
    """Return stop and number of a key such as ``stops.guide.gap``."""
    table, _, rest = name.partition(".")
    stop, _, number = rest.rpartition(".")
    return (stop, number) if table == "stops" and stop and number in STOP_NUMBERS else None


def _is_of_start(name: str) -> bool:
    return name.startswith("initial.") and not name.startswith("initial.static")


class CoreRuns:
    """The runs of a study, as the core makes them.

    Parameters
    ----------
    model
        The problem of any of the runs, as the core sees it.
    duration
        Length of a run in s.
    quantities
        What is kept.
    laws
        Number of each stop by name.
    most
        The stiffness of each stop up to which the run can be made.
    """

    def __init__(
        self,
        model: CanonicalForm,
        duration: float,
        quantities: Mapping[str, _core.Quantity],
        laws: Mapping[str, int],
        most: Mapping[str, float],
    ) -> None:
        self._model = model
        self._duration = duration
        self._most = most
        # What `simulate` looks at in each run is read behind what is kept.
        self._quantities = [*quantities.values(), _core.Quantity.of_run("energy_residual")]
        self._laws = laws

    @classmethod
    def of(cls, problem: Problem, method: str, outputs: Mapping[str, Output]) -> CoreRuns | None:
        """Return them for a problem; None where the core cannot make or read the runs."""
        model = canonical_form(problem)
        plain = all(type(law) is _core.Stop for law in model.laws)
        quantities = core_quantities(problem, outputs)
        if method not in ("auto", "exact") or not plain or quantities is None or model.states:
            return None
        if changing_speed(problem) is not None or too_stiff(problem) is not None:
            return None
        laws = {law.name: number for number, law in enumerate(problem.laws)}
        return cls(model, problem.duration, quantities, laws, stiffest(problem))

    def made(
        self,
        columns: Columns,
        shapes: Mapping[str, tuple[int, ...]],
        state_of: Callable[[Mapping[str, Level]], State],
        threads: int = 1,
    ) -> Made:
        """Make runs, all whose values are plain numbers that a stop may have.

        Parameters
        ----------
        columns
            Values of each parameter, one a run.
        shapes
            Shape of each output in a run.
        state_of
            Makes the modal state at the start from the values of ``initial``.
        threads
            How many threads make them.
        """
        count = len(next(iter(columns.values())))
        good = np.ones(count, dtype=bool)
        stops = []
        for name, levels in columns.items():
            where = _stop_number(name)
            if where is not None:
                stop, number = where
                values = _numbers(levels, number, good)
                if number == "stiffness":
                    good &= values <= self._most[stop]
                stops.append((self._laws[stop], number, values))
        of_start = {name: levels for name, levels in columns.items() if _is_of_start(name)}
        displacements = velocities = None
        if of_start:
            displacements, velocities = self._starts(of_start, state_of, good)
        model, chosen = self._model, np.flatnonzero(good)
        values, failed = _core.batch(
            model.system,
            model.laws,
            model.forcing,
            model.displacement,
            model.velocity,
            self._duration,
            self._quantities,
            len(chosen),
            [(law, number, column[chosen]) for law, number, column in stops],
            None if displacements is None else (False, displacements[chosen].ravel()),
            None if velocities is None else (False, velocities[chosen].ravel()),
            threads=threads,
        )
        good[chosen[[run for run, _ in failed]]] = False
        good[chosen] &= values[:, -1] <= LARGEST_RESIDUAL
        found, place = {}, 0
        for name, shape in shapes.items():
            width = int(np.prod(shape, dtype=int))
            found[name] = np.full((count, *shape), np.nan)
            found[name][chosen] = values[:, place : place + width].reshape(-1, *shape)
            place += width
        return Made(found, good)

    def _starts(
        self,
        columns: Columns,
        state_of: Callable[[Mapping[str, Level]], State],
        good: np.ndarray[tuple[int], np.dtype[np.bool_]],
    ) -> tuple[FloatArray, FloatArray]:
        """Return the modal state at the start of each run, (run, N) each."""
        modes = len(self._model.velocity)
        displacements, velocities = np.zeros((len(good), modes)), np.zeros((len(good), modes))
        known: dict[tuple[Level, ...], State | None] = {}
        for run, levels in enumerate(zip(*columns.values(), strict=True)):
            if levels not in known:
                known[levels] = _checked_state(state_of, dict(zip(columns, levels, strict=True)))
            state = known[levels]
            if state is None:
                good[run] = False
            else:
                displacements[run], velocities[run] = state
        return displacements, velocities


def _checked_state(
    state_of: Callable[[Mapping[str, Level]], State], values: Mapping[str, Level]
) -> State | None:
    """Return a state that the exact method takes; None where there is none."""
    try:
        displacement, velocity = state_of(values)
        return (displacement, velocity) if velocity @ velocity < MOST_ENERGY else None
    except (BumpstopError, ArithmeticError):
        return None


def _numbers(
    levels: Sequence[Level], number: str, good: np.ndarray[tuple[int], np.dtype[np.bool_]]
) -> FloatArray:
    """Return levels as numbers, and take those away that cannot be used as they are."""
    values = np.asarray(levels)
    if values.dtype.kind not in "iuf":
        plain = [isinstance(level, int | float) and type(level) is not bool for level in levels]
        values = np.where(plain, levels, np.nan)
    values = values.astype(np.float64)
    good &= np.isfinite(values)
    if number in _POSITIVE:
        good &= values > 0.0
    if number in _NOT_NEGATIVE:
        good &= values >= 0.0
    return values
