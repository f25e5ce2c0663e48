"""Responses read back from NetCDF files."""

from __future__ import annotations

import zipfile
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import h5py

from bumpstop.arguments import FloatArray
from bumpstop.errors import BumpstopError, InputError
from bumpstop.files import file_path
from bumpstop.instants import Grid
from bumpstop.io.columns import Instants, numbers, texts
from bumpstop.io.independent_dofs import kept_of_file
from bumpstop.io.reading import in_file
from bumpstop.io.repeated import RepeatedHistory
from bumpstop.io.statement import unpacked
from bumpstop.io.stored_history import StoredHistory, attributes_of
from bumpstop.methods import OPTIONS
from bumpstop.problem import Problem
from bumpstop.response import Response

if TYPE_CHECKING:
    import pandas as pd

    from bumpstop._core import History

__all__ = ["read_netcdf", "read_results"]

RESULT_COLUMNS = ("name", "quantity", "units", "value", "uncertainty")


def read_netcdf(path: str | PathLike[str]) -> Response:
    """Read a response that `Response.to_netcdf` wrote.

    It is the same response to the bit, at the instants of the file: motions, forces, gaps,
    states, strains, energies, impacts and events, what the method said of itself, and its whole
    problem (`Response.equals`). Long runs are read from the file as they are asked for, so that
    `Response.blocks` takes the memory of a block. Every number and text is held against the
    checksum that it was written with, whatever reads it. The motion between these instants is not
    in the file: where it is asked for, as by contact statistics and Poincaré sections, the run is
    repeated once from the problem, the method and the options that the file tells, which gives it
    to the bit on the same machine, and is refused where its switches or its motion at the instants
    of the file are not those of the file within 1e-9 of the duration and of the largest motion.

    Parameters
    ----------
    path
        The file.

    Raises
    ------
    InputError
        If the file cannot be read, is damaged, or holds no problem.
    """
    file = file_path(path)
    with in_file(file):
        try:
            return _read(file)
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
    with in_file(file_path(path)):
        try:
            with h5py.File(path, "r") as content:
                if "result_value" in content:
                    columns = {name: _column(content[f"result_{name}"]) for name in RESULT_COLUMNS}
        except FileNotFoundError as error:
            raise InputError("no such file", hint="check the path") from error
        except (OSError, KeyError) as error:
            raise InputError("is no response that bumpstop wrote, or is damaged") from error
    return pd.DataFrame(columns)


def _read(file: Path) -> Response:
    """Return the response of a file, which stays open where not all of it is held in memory."""
    content = h5py.File(file, "r")
    try:
        response, history = _response(content)
    except BaseException:
        content.close()
        raise
    if history.is_held:
        content.close()
    return response


def _column(dataset: h5py.Dataset) -> Any:
    return texts(dataset) if dataset.dtype.hasobject else numbers(dataset)


def _response(file: h5py.File) -> tuple[Response, StoredHistory]:
    problem = _problem(file)
    instants = _instants(file["time"])
    told = attributes_of(file)
    known = {name for options in OPTIONS.values() for name in options}
    options = {name: float(told[f"method_{name}"]) for name in known if f"method_{name}" in told}
    history = RepeatedHistory(file, problem, Instants(instants), options)
    response = Response(
        problem,
        cast("History", history),
        instants=instants,
        method_reason=str(told["method_reason"]),
        options=options,
        kept=kept_of_file(file, problem.basis),
    )
    return response, history


def _instants(times: h5py.Dataset) -> Grid | FloatArray:
    """Return the instants of a file, evenly spaced ones without reading them."""
    told = attributes_of(times)
    if "step" not in told:
        return numbers(times)
    grid = Grid(float(told["step"]), float(told["end"]))
    if len(grid) != len(times):
        raise InputError("has not the instants that it tells", key="time", value=len(times))
    return grid


def _problem(file: h5py.File) -> Problem:
    version = attributes_of(file).get("bumpstop_version", "another program")
    if "problem" not in file:
        what = f"holds no problem (written by {version})"
        hint = "only problems of bumpstop's own laws and loads, and of moderate size, are kept"
        raise InputError(what, hint=hint)
    content = numbers(file["problem"]).tobytes()
    try:
        problem = unpacked(content)
        if not isinstance(problem, Problem):
            raise TypeError("no problem")
        return replace(problem)  # which checks whether its parts fit together
    except (
        ValueError,
        KeyError,
        TypeError,
        AttributeError,
        ImportError,
        IndexError,
        zipfile.BadZipFile,
    ) as error:
        what = f"holds a problem that cannot be made here (written by bumpstop {version})"
        raise InputError(what, hint="read it with that version") from error
    except BumpstopError as error:
        raise InputError(f"holds a problem that is wrong: {error}") from error
