"""What a file holds of a run."""

from __future__ import annotations

from typing import Any

import h5py
import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.io.columns import Column, Instants, numbers, texts
from bumpstop.io.independent_dofs import motion_names
from bumpstop.io.netcdf import internal_names
from bumpstop.laws.coordinate import coordinates_of
from bumpstop.problem import Problem
from bumpstop.quantities import IMPACTS
from bumpstop.structure.sparse import IndexArray

__all__ = ["StoredHistory", "attributes_of"]

CONTACT = ("stop_force", "friction_force", "axial_force")
OF_LAWS = ("gap", "gap_rate", *CONTACT, "law_force", "state")
"""Variables of laws over time."""
TIES = ("DIMENSION_LIST", "REFERENCE_LIST")
"""Attributes by which HDF5 ties variables to their dimensions."""


class StoredHistory:
    """What a file holds of a run, in the place of the core's record.

    Parameters
    ----------
    file
        The file, open.
    problem
        What was simulated.
    instants
        The instants of the file.
    """

    is_dense = False

    def __init__(self, file: h5py.File, problem: Problem, instants: Instants) -> None:
        self._instants = instants
        self._laws = [law.name for law in problem.laws]
        self._motions = [Column(file[name]) for name in motion_names(problem.basis)]
        over_time = (
            "law_force",
            "gap",
            "gap_rate",
            "stop_force",
            "friction_force",
            "axial_force",
            "state",
        )
        self._over_time = {name: Column(file[name]) for name in over_time if name in file}
        counts = [len(coordinates_of(law, problem.basis)) for law in problem.laws]
        ends = np.cumsum(counts).tolist()
        self._coordinates = [slice(end - n, end) for n, end in zip(counts, ends, strict=True)]
        self._internal = {
            (law, column): Column(file[name])
            for name, (law, column, _) in internal_names(problem).items()
            if name in file  # files of versions before 0.2 have none
        }
        terms = (name for name in file if name.startswith("energy_"))
        self._energies = {name.removeprefix("energy_"): Column(file[name]) for name in terms}
        self._impacts = {name: numbers(file[f"impact_{name}"]) for name in IMPACTS}
        self._impact_stops = texts(file["impact_stop"])
        self._events = {
            name: texts(file[f"event_{name}"]) for name in ("law", "guard", "before", "after")
        }
        self._event_times = numbers(file["event_time"]).tolist()
        self._states = texts(file["state_name"]) if "state_name" in file else []
        self._told = attributes_of(file)
        self.duration = problem.duration

    @property
    def is_held(self) -> bool:
        """Whether all is in memory, so that the file is not needed any more."""
        held = [*self._over_time.values(), *self._internal.values(), *self._energies.values()]
        return all(column.is_held for column in (*self._motions, *held))

    @property
    def method(self) -> str:
        """Name of the method."""
        return str(self._told["method"])

    @property
    def steps(self) -> int:
        """Cells or time steps of the run."""
        return int(self._told["steps"])

    @property
    def event_count(self) -> int:
        """Switches of the run."""
        return int(self._told["event_count"])

    @property
    def seconds(self) -> float:
        """The core's time when the file was written."""
        return float(self._told["solve_seconds"])

    @property
    def motion_error(self) -> float | None:
        """Bound of the error of the motion in m, where the method has one."""
        return self._told.get("motion_error")

    @property
    def missed_penetration(self) -> float | None:
        """Depth in m that no contact missed can have exceeded, where known."""
        return self._told.get("missed_penetration")

    def energy_residual(self) -> float:
        """Return the largest imbalance of the ledger, relative to the largest energy."""
        return float(self._told["relative_energy_residual"])

    def motion(self, times: FloatArray, derivative: int) -> FloatArray:
        """Return the motion of the canonical modes, or of the dofs kept, (time, mode)."""
        motion: FloatArray = self._motions[derivative].at(self._at(times))
        return motion

    def project(self, row: FloatArray, times: FloatArray, derivative: int) -> FloatArray:
        """Return a linear combination of the modes, (time,)."""
        from bumpstop.projection import along

        return along(row, self.motion(times, derivative))

    def law_motion(self, law: int, times: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return distance, its rate and the force of one law, each (time,)."""
        at = self._at(times)
        names = ("gap", "gap_rate", "stop_force")
        gap, rate, force = (self._over_time[name].at(at)[:, law] for name in names)
        return gap, rate, force

    def law_forces(self, law: int, times: FloatArray) -> FloatArray:
        """Return the forces of one law along its coordinates, (time, coordinate)."""
        at = self._at(times)
        if "law_force" in self._over_time:
            return self._over_time["law_force"].at(at)[:, self._coordinates[law]].copy()
        return self._over_time["stop_force"].at(at)[:, [law]]

    def contact_forces(self, law: int, times: FloatArray) -> FloatArray:
        """Return the force along the normal of the contact and across it, (time, 3)."""
        at = self._at(times)
        names = ("stop_force", "friction_force", "axial_force")
        known = [self._over_time[name].at(at)[:, law] for name in names if name in self._over_time]
        return np.stack([*known, *[np.zeros(len(times))] * (3 - len(known))], axis=1)

    def law_states(self, law: int, times: FloatArray) -> list[str]:
        """Return the state of one law at each time."""
        flags = self._over_time["state"].at(self._at(times))[:, law]
        return [self._states[flag] for flag in flags]

    def internal_variables(self, law: int, times: FloatArray) -> FloatArray:
        """Return what a law remembers, (time, 2); NaN where there is nothing."""
        at = self._at(times)
        found = np.full((len(at), 2), np.nan)
        for (owner, place), column in self._internal.items():
            if owner == law:
                found[:, place] = column.at(at)
        return found

    def energy(self, times: FloatArray) -> dict[str, FloatArray]:
        """Return the terms of the ledger in J; the first time must be the start."""
        # Whoever asks for energies asks for the start first; of it the file has the total alone.
        at = self._at(times[1:])
        whole = {name: self._with_start(self._energies[name].at(at)) for name in _LEDGER.values()}
        whole["kinetic"][0] = self._energies["total_initial"].at(np.zeros(1, dtype=np.intp))[0]
        shares = {
            core: np.stack([self._with_start(column) for column in self._energies[name].at(at).T])
            if self._laws
            else np.zeros((0, len(times)))
            for core, name in _SHARES.items()
        }
        return {core: whole[name] for core, name in _LEDGER.items()} | shares

    def impacts(self, law: int) -> dict[str, FloatArray]:
        """Return the impacts of one stop."""
        own = np.array([stop == self._laws[law] for stop in self._impact_stops], dtype=bool)
        return {name: column[own] for name, column in self._impacts.items()}

    def events(self) -> dict[str, list[float] | list[int] | list[str]]:
        """Return the switches of all laws."""
        laws = [self._laws.index(name) for name in self._events["law"]]
        return {"time": self._event_times, **self._events, "law": laws}

    def _with_start(self, values: FloatArray) -> FloatArray:
        return np.concatenate([[0.0], values])

    def _at(self, times: FloatArray) -> IndexArray:
        """Return the rows of instants; InputError where one is not in the file."""
        return self._instants.rows(np.asarray(times))


_LEDGER = {
    "kinetic": "kinetic",
    "elastic": "elastic",
    "modal_dissipation": "dissipated_damping",
    "load_work": "load_work",
    "circulatory_work": "circulatory_work",
    "obstacle_work": "obstacle_work",
}
"""Terms as the core calls them, and as the file does."""

_SHARES = {"law_stored": "stored_in_stop", "law_dissipated": "dissipated_in_stop"}


def attributes_of(thing: h5py.File | h5py.Dataset) -> dict[str, Any]:
    """Return what is told of a file or of a variable: single numbers and texts."""
    values = {name: np.asarray(thing.attrs[name]) for name in thing.attrs if name not in TIES}
    told = {name: value.item() for name, value in values.items() if value.ndim == 0}
    return {
        name: value.decode() if isinstance(value, bytes) else value for name, value in told.items()
    }
