"""The NetCDF-4 format: HDF5 datasets whose dimensions are tied to dimension scales.

Written with h5py alone, through the calls of it that go straight to HDF5: a short run feels
what a file of fifty small variables takes. ``h5py.File.create_dataset`` and the like need more
than twice as long, and h5netcdf, which xarray reads these files with, ten times.

Damage is seen when a file is read: numbers lie in pieces with a checksum each, which HDF5 looks
at in whatever program; so do all that it keeps of names and attributes since version 1.8; texts,
which lie in a heap without, have one in an attribute.

References
----------
Unidata, *NetCDF file format specifications*, "The NetCDF-4/HDF5 file format".
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Iterable, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import h5py
import numpy as np
from h5py import h5a, h5d, h5ds, h5p, h5s, h5t

from bumpstop.io.room import new_hdf5

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

__all__ = ["CHECKSUM", "Growth", "Variable", "checksum", "write_file"]

NO_VARIABLE = b"This is a netCDF dimension but not a netCDF variable.%10d"
"""What the format wants a dimension scale to be called that stands for no variable."""

IN_ORDER = h5p.CRT_ORDER_TRACKED | h5p.CRT_ORDER_INDEXED
"""The format keeps dimensions, variables and attributes in the order in which they were made."""

CHECKSUM = "crc32"
"""The attribute that has the checksum of a variable of texts.

Those of numbers are kept by HDF5 itself, one for each piece; texts lie in a heap that has none.
"""
PIECE = 65_536
"""Numbers in a piece that has a checksum of its own: half of what HDF5 holds of each variable."""

HEAD = 8192
"""Bytes that name, attributes and index of a variable take at most."""

GROWTH = 1024
"""Values in a piece of a dimension without length: it can only be one that may grow."""

SCALAR = h5s.create(h5s.SCALAR)


class Variable(NamedTuple):
    """One variable: a coordinate where it has the name of its only dimension."""

    name: str
    dimensions: tuple[str, ...]
    values: NDArray[Any]
    """Numbers, or strings as objects."""
    attributes: Mapping[str, Any]

    @property
    def is_coordinate(self) -> bool:
        """Whether it gives the values of a dimension."""
        return self.dimensions == (self.name,)


class Growth(NamedTuple):
    """What follows the first block of variables along one dimension."""

    dimension: str
    length: int
    """Of the dimension in the whole file."""
    blocks: Iterable[tuple[int, Iterable[Variable]]]
    """Where each block begins, and its variables; those without the dimension are passed over."""


def checksum(words: list[bytes]) -> str:
    """Return the checksum of some texts.

    >>> checksum([b"open", b"closed"])
    '3872ccaf'
    """
    joined = b"\0".join(words)
    return f"{zlib.crc32(joined):08x}"


def write_file(
    path: Path,
    variables: Iterable[Variable],
    attributes: Mapping[str, Any],
    further: Growth | None = None,
) -> None:
    """Write a NetCDF-4 file.

    Parameters
    ----------
    path
        The file.
    variables
        What it holds; variables that share a dimension must agree on its length.
    attributes
        Strings and numbers that tell about the whole file.
    further
        More of the variables that begin with one dimension.
    """
    listed = list(variables)
    lengths = {} if further is None else {further.dimension: further.length}
    size = sum(_size(each, lengths) for each in listed)
    with new_hdf5(path, size, track_order=True, libver=("v108", "v108")) as file:
        group = file["/"].id
        _set_attributes(group, {"_NCProperties": f"version=2,h5py={h5py.__version__}"})
        _set_attributes(group, attributes)
        datasets = {variable.name: _dataset(group, variable, lengths) for variable in listed}
        scales = _scales(group, listed, datasets, lengths)
        for variable in listed:
            _tie(datasets[variable.name], variable, scales)
        if further is not None:
            _write_further(further, datasets)


def _size(variable: Variable, lengths: Mapping[str, int]) -> int:
    """Return how many bytes a variable takes in the whole file, at most."""
    values = variable.values
    shape: list[int] = [
        lengths.get(dimension, length)
        for dimension, length in zip(variable.dimensions, values.shape, strict=True)
    ]
    # Texts lie in a heap beside the references to them.
    words = sum(4 * len(text) + 64 for text in values.flat) if values.dtype.hasobject else 0
    return HEAD + words + values.itemsize * math.prod(shape)


def _dataset(
    group: h5py.h5g.GroupID, variable: Variable, lengths: Mapping[str, int]
) -> h5d.DatasetID:
    values = np.ascontiguousarray(variable.values).reshape(variable.values.shape)
    stored, in_memory = _types(values.dtype)
    sizes: tuple[int, ...] = values.shape
    shape = tuple(
        lengths.get(dimension, sizes[axis]) for axis, dimension in enumerate(variable.dimensions)
    )
    dataset = _created(group, variable.name, stored, shape)
    if shape != values.shape:
        _write_rows(dataset, values, in_memory, 0)
    elif values.size:
        dataset.write(h5s.ALL, h5s.ALL, values, in_memory)
    _set_attributes(dataset, variable.attributes)
    if values.dtype.hasobject:
        words = [str(text).encode() for text in values]
        _set_attributes(dataset, {CHECKSUM: checksum(words)})
    return dataset


def _write_further(further: Growth, datasets: Mapping[str, h5d.DatasetID]) -> None:
    for start, variables in further.blocks:
        for variable in variables:
            if variable.dimensions[0] == further.dimension:
                values = np.ascontiguousarray(variable.values)
                _write_rows(datasets[variable.name], values, _types(values.dtype)[1], start)


def _write_rows(
    dataset: h5d.DatasetID, values: NDArray[Any], in_memory: h5t.TypeID, start: int
) -> None:
    """Write rows from a number on."""
    if not values.size:
        return
    place = dataset.get_space()
    place.select_hyperslab((start, *(0 for _ in values.shape[1:])), values.shape)
    dataset.write(h5s.create_simple(values.shape), place, values, in_memory)


def _created(
    group: h5py.h5g.GroupID, name: str, stored: h5t.TypeID, shape: tuple[int, ...]
) -> h5d.DatasetID:
    largest = tuple(length or h5s.UNLIMITED for length in shape)
    space = h5s.create_simple(shape, largest)
    is_text = isinstance(stored, h5t.TypeStringID)
    return h5d.create(group, name.encode(), stored, space, _layout(shape, is_text))


@cache
def _layout(shape: tuple[int, ...], is_text: bool) -> h5p.PropDCID:
    """Return how a dataset is stored: numbers in pieces, each with its checksum.

    Texts are, too, where a dimension is without length.
    """
    layout = h5p.create(h5p.DATASET_CREATE)
    layout.set_obj_track_times(False)
    layout.set_attr_creation_order(IN_ORDER)
    if 0 in shape:
        layout.set_chunk(tuple(length or GROWTH for length in shape))
    elif not is_text:
        rows = max(PIECE // math.prod(shape[1:]), 1)
        layout.set_chunk((min(rows, shape[0]), *shape[1:]))
        layout.set_fletcher32()
    return layout


def _scales(
    group: h5py.h5g.GroupID,
    variables: list[Variable],
    datasets: dict[str, h5d.DatasetID],
    whole: Mapping[str, int],
) -> dict[str, h5d.DatasetID]:
    """Make a dimension scale of every coordinate, and one for each dimension without."""
    lengths: dict[str, int] = {}
    for variable in variables:
        lengths.update(zip(variable.dimensions, variable.values.shape, strict=True))
    lengths |= whole
    scales = {}
    for number, (name, length) in enumerate(lengths.items()):
        title = name.encode()
        scale = datasets.get(name)
        if scale is None:
            title = NO_VARIABLE % length
            scale = _created(group, name, h5t.IEEE_F32BE, (length,))
        h5ds.set_scale(scale, title)
        _set_attributes(scale, {"_Netcdf4Dimid": np.int32(number)})
        scales[name] = scale
    return scales


def _tie(dataset: h5d.DatasetID, variable: Variable, scales: dict[str, h5d.DatasetID]) -> None:
    if variable.is_coordinate:
        return
    for axis, dimension in enumerate(variable.dimensions):
        h5ds.attach_scale(dataset, scales[dimension], axis)


def _set_attributes(thing: h5py.h5g.GroupID | h5d.DatasetID, attributes: Mapping[str, Any]) -> None:
    for name, value in attributes.items():
        if isinstance(value, str):
            content = np.array(value.encode() or b"\0")
            stored = in_memory = _text_type(content.itemsize)
        else:
            content = np.array(value)
            stored, in_memory = _types(content.dtype)
        space = h5s.create_simple(content.shape) if content.ndim else SCALAR
        h5a.create(thing, name.encode(), stored, space).write(content, in_memory)


@cache
def _types(dtype: np.dtype[Any]) -> tuple[h5t.TypeID, h5t.TypeID]:
    """Return the types in the file and in memory of numbers, or of texts as objects."""
    kind = h5py.string_dtype() if dtype.hasobject else dtype
    return h5t.py_create(kind, logical=True), h5t.py_create(kind)


@cache
def _text_type(length: int) -> h5t.TypeID:
    """Return a text of fixed length, NetCDF's own kind: not every reader knows the other."""
    return h5t.py_create(h5py.string_dtype("utf-8", length), logical=True)
