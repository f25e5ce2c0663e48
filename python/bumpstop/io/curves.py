"""Curves of results in NetCDF files: spectra, histograms, sections and whatever else is drawn.

Each is a variable ``curve_NAME``, with dimensions and coordinates of its own, since two spectra
need not have the same frequencies. Its attributes are those of the array, beside the name of the
result, and which axes are logarithmic.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np

from bumpstop.errors import InputError
from bumpstop.files import file_path
from bumpstop.io.columns import numbers, texts
from bumpstop.io.netcdf_format import CHECKSUM, Variable
from bumpstop.io.reading import in_file
from bumpstop.io.stored_history import attributes_of
from bumpstop.quantities import plain_names

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from bumpstop.post.results.reading import Drawn, Result
    from bumpstop.response import Response

__all__ = ["curve_variables", "read_curves"]

OURS = "curve_"
"""What names of variables, and of attributes that say what a variable is, begin with."""
FORMAT = ("CLASS", "NAME", "_Netcdf4Dimid", CHECKSUM)
"""Attributes that belong to the format."""


def curve_variables(response: Response, results: Sequence[Result]) -> Iterator[Variable]:
    """Give the curves of results, each with its coordinates."""
    from bumpstop.post.results.reading import read_result

    drawn = [(each.name, one) for each in results for one in read_result(each, response).figures]
    names = plain_names(f"{OURS}{name}_{one.array.name}_{n}" for n, (name, one) in enumerate(drawn))
    for name, (result, one) in zip(names, drawn, strict=True):
        yield from _curve(name, result, one)


def _curve(name: str, result: str, one: Drawn) -> Iterator[Variable]:
    array = one.array
    labels = [str(label) for label in array.coords]
    told = {
        "of": result,
        "name": str(array.name),
        "logarithmic": one.log,
        "labels": " ".join(labels),
    }
    yield _variable(name, name, array, told)
    for label in labels:
        yield _variable(name, f"{name}_{label}", array.coords[label], {})


def _variable(curve: str, name: str, array: xr.DataArray, told: Mapping[str, str]) -> Variable:
    """Return an array as a variable; a single number is one along a dimension of its own."""
    dims = [str(dim) for dim in array.dims]
    attributes = {**array.attrs, **_ours({**told, "dimensions": " ".join(dims)})}
    values = array.values.astype(object) if array.dtype.kind == "U" else array.values
    own = tuple(f"{curve}_{dim}" for dim in dims) or (name,)
    return Variable(name, own, values.reshape(values.shape or 1), attributes)


def _ours(told: Mapping[str, str]) -> dict[str, str]:
    return {f"{OURS}{key}": value for key, value in told.items()}


def read_curves(path: str | PathLike[str]) -> dict[str, list[xr.DataArray]]:
    """Read the curves of the results that a case had asked for, from the file of a run.

    Parameters
    ----------
    path
        A file of ``bumpstop run --out``, or of `Response.to_netcdf` with ``results``.

    Returns
    -------
    dict
        For each result that has curves, in the order of the case, what it draws: spectra over
        frequencies, histograms over classes, forces over time, each as it was, to the bit;
        `bumpstop.plot` draws them.

    Raises
    ------
    InputError
        If the file cannot be read or is damaged.
    """
    found: dict[str, list[xr.DataArray]] = {}
    with in_file(file_path(path)):
        try:
            with h5py.File(path, "r") as content:
                for name in content:
                    told = attributes_of(content[name])
                    if f"{OURS}of" in told:
                        curves = found.setdefault(str(told[f"{OURS}of"]), [])
                        curves.append(_read(content, name))
        except FileNotFoundError as error:
            raise InputError("no such file", hint="check the path") from error
        except (OSError, KeyError) as error:
            raise InputError("is no response that bumpstop wrote, or is damaged") from error
    return found


def _read(content: h5py.File, name: str) -> xr.DataArray:
    import xarray as xr

    dims, values, attributes = _parts(content[name])
    told = attributes_of(content[name])
    labels = str(told[f"{OURS}labels"]).split()
    coordinates = {label: _parts(content[f"{name}_{label}"]) for label in labels}
    return xr.DataArray(values, coordinates, dims, str(told[f"{OURS}name"]), attributes)


def _parts(dataset: h5py.Dataset) -> tuple[list[str], NDArray[Any], dict[str, Any]]:
    """Return dimensions, values and attributes of an array."""
    told = attributes_of(dataset)
    dims = str(told[f"{OURS}dimensions"]).split()
    values = np.array(texts(dataset)) if dataset.dtype.hasobject else numbers(dataset)
    kept = {
        name: value
        for name, value in told.items()
        if not name.startswith(OURS) and name not in FORMAT
    }
    return dims, values if dims else values[0], kept
