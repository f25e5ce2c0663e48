"""The NetCDF-4 format: HDF5 datasets whose dimensions are tied to dimension scales.

Written with h5py alone. h5netcdf, which xarray reads these files with, takes six times as
long to write one, as much as all the rest of a short run.

References
----------
Unidata, *NetCDF file format specifications*, "The NetCDF-4/HDF5 file format".
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from pathlib import Path

    import h5py
    from numpy.typing import NDArray

__all__ = ["Variable", "write_file"]

NO_VARIABLE = b"This is a netCDF dimension but not a netCDF variable.%10d"
"""What the format wants a dimension scale to be called that stands for no variable."""


class Variable(NamedTuple):
    """One variable: a coordinate where it has the name of its only dimension."""

    name: str
    dimensions: tuple[str, ...]
    values: NDArray[Any]
    """Numbers, or strings as objects."""
    attributes: Mapping[str, str]


def write_file(path: Path, variables: Iterable[Variable], attributes: Mapping[str, Any]) -> None:
    """Write a NetCDF-4 file.

    Parameters
    ----------
    path
        The file.
    variables
        What it holds; variables that share a dimension must agree on its length.
    attributes
        Strings and numbers that tell about the whole file.
    """
    import h5py

    # The format keeps dimensions and variables in the order in which they were made.
    with h5py.File(path, "w", track_order=True) as file:
        _set_attributes(file, {"_NCProperties": f"version=2,h5py={h5py.__version__}"})
        _set_attributes(file, attributes)
        listed = list(variables)
        datasets = {variable.name: _dataset(file, variable) for variable in listed}
        scales = _scales(file, listed, datasets)
        for variable in listed:
            _tie(datasets[variable.name], variable, scales)


def _dataset(file: h5py.File, variable: Variable) -> h5py.Dataset:
    import h5py

    values = variable.values
    dtype = h5py.string_dtype() if values.dtype == object else values.dtype
    # A dimension without length can only be one that may grow.
    growing = None if values.size else tuple(length or None for length in values.shape)
    data = values if values.size else None
    dataset = file.create_dataset(
        variable.name, values.shape, dtype, data, maxshape=growing, track_order=True
    )
    _set_attributes(dataset, variable.attributes)
    return dataset


def _scales(
    file: h5py.File, variables: list[Variable], datasets: dict[str, h5py.Dataset]
) -> dict[str, h5py.Dataset]:
    """Make a dimension scale of every coordinate, and one for each dimension without."""
    lengths: dict[str, int] = {}
    for variable in variables:
        lengths.update(zip(variable.dimensions, variable.values.shape, strict=True))
    scales = {}
    for number, (name, length) in enumerate(lengths.items()):
        scale = datasets.get(name)
        if scale is None:
            growing = None if length else (None,)
            scale = file.create_dataset(name, (length,), ">f4", maxshape=growing)
            scale.make_scale(NO_VARIABLE % length)
        else:
            scale.make_scale(name)
        scale.attrs["_Netcdf4Dimid"] = np.int32(number)
        scales[name] = scale
    return scales


def _tie(dataset: h5py.Dataset, variable: Variable, scales: dict[str, h5py.Dataset]) -> None:
    if variable.dimensions == (variable.name,):
        return
    for axis, dimension in enumerate(variable.dimensions):
        dataset.dims[axis].attach_scale(scales[dimension])


def _set_attributes(thing: h5py.File | h5py.Dataset, attributes: Mapping[str, Any]) -> None:
    import h5py

    for name, value in attributes.items():
        if isinstance(value, str):
            # Of fixed length, NetCDF's own kind of text: not every reader knows the other.
            text = value.encode()
            thing.attrs.create(name, text, dtype=h5py.string_dtype("utf-8", max(len(text), 1)))
        else:
            thing.attrs[name] = value
