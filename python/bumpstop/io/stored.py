"""Responses read back from NetCDF files."""

from __future__ import annotations

import zipfile
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import h5py
import numpy as np

from bumpstop.arguments import FloatArray
from bumpstop.errors import BumpstopError, InputError
from bumpstop.io.reading import in_file
from bumpstop.io.statement import unpacked
from bumpstop.methods import OPTIONS
from bumpstop.problem import Problem
from bumpstop.quantities import IMPACTS
from bumpstop.response import Response
from bumpstop.sampling import MOTIONS

if TYPE_CHECKING:
    import pandas as pd

    from bumpstop._core import History

__all__ = ["StoredHistory", "read_netcdf", "read_results"]

RESULT_COLUMNS = ("name", "quantity", "units", "value", "uncertainty")


def read_netcdf(path: str | PathLike[str]) -> Response:
    """Read a response that `Response.to_netcdf` wrote.

    It is the same response to the bit, at the instants of the file: motions, forces, gaps,
    states, strains, energies, impacts and events, what the method said of itself, and its whole
    problem (`Response.equals`). The motion between these instants is not in the file: to read it
    anywhere else, simulate the problem again, ``bs.simulate(response.problem, response.method)``.

    Parameters
    ----------
    path
        The file.

    Raises
    ------
    InputError
        If the file cannot be read, is damaged, or holds no problem.
    """
    file = Path(path)
    with in_file(file):
        try:
            with h5py.File(file, "r") as content:
                return _response(content)
        except FileNotFoundError as error:
            raise InputError("no such file", hint="check the path") from error
        except (OSError, KeyError, RuntimeError) as error:  # h5py raises all three
            what = "is no response that bumpstop wrote, or is damaged"
            raise InputError(what, hint="Response.to_netcdf writes one") from error


def read_results(path: str | PathLike[str]) -> pd.DataFrame:
    """Read the numbers of the results that a case had asked for, from the file of a run.

    Parameters
    ----------
    path
        A file of ``bumpstop run --out``, or of `Response.to_netcdf` with ``results``.

    Returns
    -------
    pandas.DataFrame
        One row a number: ``name`` of the result, ``quantity`` in words, ``units``, ``value``, and
        ``uncertainty``, its standard error, NaN where there is none. No rows where there are no
        results.

    Raises
    ------
    InputError
        If the file cannot be read or is damaged.
    """
    import pandas as pd

    columns: dict[str, Any] = {name: [] for name in RESULT_COLUMNS}
    with in_file(Path(path)):
        try:
            with h5py.File(path, "r") as content:
                if "result_value" in content:
                    columns = {name: _column(content[f"result_{name}"]) for name in RESULT_COLUMNS}
        except FileNotFoundError as error:
            raise InputError("no such file", hint="check the path") from error
        except (OSError, KeyError) as error:
            raise InputError("is no response that bumpstop wrote, or is damaged") from error
    return pd.DataFrame(columns)


def _column(dataset: h5py.Dataset) -> Any:
    return _texts(dataset) if dataset.dtype.hasobject else dataset[()]


def _response(file: h5py.File) -> Response:
    problem = _problem(file)
    times = file["time"][()]
    attributes = _attributes(file)
    known = {name for options in OPTIONS.values() for name in options}
    options = {
        name: float(attributes[f"method_{name}"])
        for name in known
        if f"method_{name}" in attributes
    }
    return Response(
        problem,
        cast("History", StoredHistory(file, problem, times)),
        instants=times,
        method_reason=str(attributes["method_reason"]),
        options=options,
    )


def _problem(file: h5py.File) -> Problem:
    version = _attributes(file).get("bumpstop_version", "another program")
    if "problem" not in file:
        what = f"holds no problem (written by {version})"
        hint = "only problems of bumpstop's own laws and loads, and of moderate size, are kept"
        raise InputError(what, hint=hint)
    try:
        problem = unpacked(file["problem"][()].tobytes())
        if not isinstance(problem, Problem):
            raise TypeError("no problem")
        return replace(problem)  # which checks whether its parts fit together
    except (
        ValueError,
        KeyError,
        TypeError,
        AttributeError,
        ImportError,
        zipfile.BadZipFile,
    ) as error:
        what = f"holds a problem that cannot be made here (written by bumpstop {version})"
        raise InputError(what, hint="read it with that version") from error
    except BumpstopError as error:
        raise InputError(f"holds a problem that is wrong: {error}") from error


class StoredHistory:
    """What a file holds of a run, in the place of the core's record.

    Parameters
    ----------
    file
        The file, open.
    problem
        What was simulated.
    times
        The instants of the file in s, (n,).
    """

    is_dense = False

    def __init__(self, file: h5py.File, problem: Problem, times: FloatArray) -> None:
        self._times = times
        self._rows = {time: row for row, time in enumerate(times.tolist())}
        self._laws = [law.name for law in problem.laws]
        own = "modal" if problem.basis.coordinates is None else "canonical"
        self._motions = [file[f"{own}_{quantity}"][()] for quantity in MOTIONS]
        over_time = ("gap", "gap_rate", "stop_force", "friction_force", "axial_force", "state")
        self._over_time = {name: file[name][()] for name in over_time if name in file}
        energies = (name for name in file if name.startswith("energy_"))
        self._energies = {name.removeprefix("energy_"): file[name][()] for name in energies}
        self._impacts = {name: file[f"impact_{name}"][()] for name in IMPACTS}
        self._impact_stops = _texts(file["impact_stop"])
        self._events = {
            name: _texts(file[f"event_{name}"]) for name in ("law", "guard", "before", "after")
        }
        self._event_times = file["event_time"][()].tolist()
        self._states = _texts(file["state_name"]) if "state_name" in file else []
        self._told = _attributes(file)
        self.duration = problem.duration

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
        """Return the motion of the canonical modes, (time, mode)."""
        motion: FloatArray = self._motions[derivative][self._at(times)]
        return motion

    def project(self, row: FloatArray, times: FloatArray, derivative: int) -> FloatArray:
        """Return a linear combination of the modes, (time,)."""
        from bumpstop.projection import along

        return along(row, self.motion(times, derivative))

    def law_motion(self, law: int, times: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return distance, its rate and the force of one law, each (time,)."""
        at = self._at(times)
        gap, rate, force = (self._over_time[name] for name in ("gap", "gap_rate", "stop_force"))
        return gap[at, law], rate[at, law], force[at, law]

    def law_forces(self, law: int, times: FloatArray) -> FloatArray:
        """Return the forces of one law along its coordinates, (time, coordinate)."""
        at = self._at(times)
        names = (name for name in ("stop_force", "friction_force") if name in self._over_time)
        return np.stack([self._over_time[name][at, law] for name in names], axis=1)

    def contact_forces(self, law: int, times: FloatArray) -> FloatArray:
        """Return the force along the normal of the contact and across it, (time, 3)."""
        at = self._at(times)
        names = ("stop_force", "friction_force", "axial_force")
        known = [self._over_time[name][at, law] for name in names if name in self._over_time]
        return np.stack([*known, *[np.zeros(len(times))] * (3 - len(known))], axis=1)

    def law_states(self, law: int, times: FloatArray) -> list[str]:
        """Return the state of one law at each time."""
        return [self._states[flag] for flag in self._over_time["state"][self._at(times), law]]

    def energy(self, times: FloatArray) -> dict[str, FloatArray]:
        """Return the terms of the ledger in J; the first time must be the start."""
        # Whoever asks for energies asks for the start first; of it the file has the total alone.
        at = self._at(times[1:])
        whole = {name: self._with_start(self._energies[name][at]) for name in _LEDGER.values()}
        whole["kinetic"][0] = self._energies["total_initial"][0]
        shares = {
            core: np.stack([self._with_start(column) for column in self._shares(name)[at].T])
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

    def _shares(self, name: str) -> FloatArray:
        shares: FloatArray = self._energies[name]
        return shares

    def _with_start(self, values: FloatArray) -> FloatArray:
        return np.concatenate([[0.0], values])

    def _at(self, times: FloatArray) -> list[int]:
        """Return the rows of instants; InputError where one is not in the file."""
        rows = [self._rows.get(time, -1) for time in times.tolist()]
        if -1 in rows:
            raise InputError(
                "is not among the instants of the file",
                key="times",
                value=float(times[rows.index(-1)]),
                hint="to read it anywhere, simulate the response's problem again",
            )
        return rows


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


def _texts(dataset: h5py.Dataset) -> list[str]:
    return [text.decode() for text in dataset[()]]


def _attributes(file: h5py.File) -> dict[str, Any]:
    """Return what is told of the whole file: numbers and texts."""
    values = {name: np.asarray(value).item() for name, value in file.attrs.items()}
    return {
        name: value.decode() if isinstance(value, bytes) else value
        for name, value in values.items()
    }
