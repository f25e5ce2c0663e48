"""A run that a file tells, repeated where it is asked for what is between the file's instants."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from functools import cached_property
from typing import TYPE_CHECKING

import h5py
import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import ComputationError, InputError, ModellingWarning
from bumpstop.io.columns import Instants
from bumpstop.io.stored_history import StoredHistory
from bumpstop.methods import FIXED_STEP_METHODS
from bumpstop.problem import Problem

if TYPE_CHECKING:
    from bumpstop._core import History

__all__ = ["RepeatedHistory"]

LOOKS = 1000
"""Instants of the file at most at which the repeated motion is held against it."""
APART = 1e-9
"""What both may differ by, relative to the duration and to the largest motion: other processors
and versions round otherwise."""


class RepeatedHistory(StoredHistory):
    """What a file holds of a run, and the run anew for every instant that it does not hold.

    The problem, the method and its options stand in the file, and a run of them has one outcome,
    to the bit on the same machine. It is computed once, when first needed, and held against the
    switches and the motion of the file.

    Parameters
    ----------
    file
        The file, open.
    problem
        What was simulated.
    instants
        The instants of the file.
    options
        Those of the method.
    """

    def __init__(
        self, file: h5py.File, problem: Problem, instants: Instants, options: Mapping[str, float]
    ) -> None:
        super().__init__(file, problem, instants)
        self._problem = problem
        self._options = options
        self._name = str(file.filename)

    def motion(self, times: FloatArray, derivative: int) -> FloatArray:
        """Return the motion of the canonical modes, or of the dofs kept, (time, mode)."""
        if self._holds(times):
            return super().motion(times, derivative)
        return self._anew.motion(times, derivative)

    def project(self, row: FloatArray, times: FloatArray, derivative: int) -> FloatArray:
        """Return a linear combination of the modes, (time,)."""
        if self._holds(times):
            return super().project(row, times, derivative)
        return self._anew.project(row, times, derivative)

    def law_motion(self, law: int, times: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return distance, its rate and the force of one law, each (time,)."""
        if self._holds(times):
            return super().law_motion(law, times)
        return self._anew.law_motion(law, times)

    def law_forces(self, law: int, times: FloatArray) -> FloatArray:
        """Return the forces of one law along its coordinates, (time, coordinate)."""
        if self._holds(times):
            return super().law_forces(law, times)
        return self._anew.law_forces(law, times)

    def contact_forces(self, law: int, times: FloatArray) -> FloatArray:
        """Return the force along the normal of the contact and across it, (time, 3)."""
        if self._holds(times):
            return super().contact_forces(law, times)
        return self._anew.contact_forces(law, times)

    def law_states(self, law: int, times: FloatArray) -> list[str]:
        """Return the state of one law at each time."""
        if self._holds(times):
            return super().law_states(law, times)
        return self._anew.law_states(law, times)

    def internal_variables(self, law: int, times: FloatArray) -> FloatArray:
        """Return what a law remembers, (time, 2); NaN where there is nothing."""
        if self._holds(times):
            return super().internal_variables(law, times)
        return self._anew.internal_variables(law, times)

    def energy(self, times: FloatArray) -> dict[str, FloatArray]:
        """Return the terms of the ledger in J; the first time must be the start."""
        if self._holds(times[1:]):
            return super().energy(times)
        return self._anew.energy(times)

    def _holds(self, times: FloatArray) -> bool:
        return self._instants.hold(np.asarray(times))

    @cached_property
    def _anew(self) -> History:
        """The run, computed again."""
        from bumpstop.simulate import simulate

        steps_unstable = self.method in FIXED_STEP_METHODS  # as the first run may have done
        asked = dict(self._options) | ({"beyond_stability_limit": True} if steps_unstable else {})
        if "exact_flights" in asked:
            asked["exact_flights"] = bool(asked["exact_flights"])
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModellingWarning)  # the first run has told them
            try:
                response = simulate(self._problem, self.method, **asked)  # type: ignore[arg-type]
            except ComputationError as error:
                raise self._departed("it does not come to its end") from error
        self._hold_against(response.history)
        return response.history

    def _hold_against(self, anew: History) -> None:
        """Raise where a run is not that of the file."""
        mine, yours = self.events(), anew.events()
        if any(mine[what] != yours[what] for what in ("law", "before", "after")):
            raise self._departed("laws switch otherwise")
        apart = np.abs(np.asarray(mine["time"]) - np.asarray(yours["time"])).max(initial=0.0)
        if not apart <= APART * self.duration:
            raise self._departed(f"a law switches {apart:.1e} s apart")
        held = self._instants.times
        looks = np.unique(np.linspace(0, len(held) - 1, min(len(held), LOOKS)).astype(np.intp))
        times = np.array([held[k] for k in looks.tolist()])
        for derivative in (0, 1):
            told, found = super().motion(times, derivative), anew.motion(times, derivative)
            if told.shape != found.shape:
                raise self._departed("it keeps the motion of other dofs")
            apart, largest = np.abs(found - told).max(initial=0.0), np.abs(told).max(initial=0.0)
            if not apart <= APART * largest:
                raise self._departed(f"the motion is {apart / largest:.1e} of its largest apart")

    def _departed(self, how: str) -> InputError:
        what = f"lacks an instant, and the run repeated for it is not that of the file: {how}"
        hint = "read the instants of the file alone, or simulate its problem anew"
        return InputError(what, key="times", file=self._name, hint=hint)
