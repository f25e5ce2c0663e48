"""Archives of arrays (.npz): looked at before they are read."""

from __future__ import annotations

import zipfile
import zlib
from pathlib import Path
from tokenize import TokenError
from typing import IO, Any

import numpy as np
from numpy.lib import format as npy

from bumpstop.errors import InputError
from bumpstop.io.reading import read_content

__all__ = ["UNREADABLE", "check_members", "read_arrays"]

UNREADABLE = (ValueError, EOFError, SyntaxError, TokenError)
"""What NumPy raises for damaged files: headers are literals of Python."""


def check_members(path: Path, kind: str) -> None:
    """Raise where a file is no archive of arrays, or an array is larger than its data.

    Reading would make room for what a header announces before it finds the data missing.

    Raises
    ------
    InputError
        If it is not an archive of arrays without pickled objects, or is damaged.
    """
    read_content(path, kind)
    try:
        with zipfile.ZipFile(path) as archive:
            for member in archive.infolist():
                with archive.open(member) as file:
                    _check_array(member.filename, file, member.file_size)
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError) as error:
        raise InputError(f"is not {kind}, or is truncated") from error


def read_arrays(path: Path, kind: str) -> dict[str, Any]:
    """Return all arrays of an archive by name.

    Raises
    ------
    InputError
        If it is not an archive of arrays without pickled objects, or is damaged.
    """
    check_members(path, kind)
    try:
        with np.load(path, allow_pickle=False) as archive:
            return {name: archive[name] for name in archive.files}
    except (*UNREADABLE, zipfile.BadZipFile, zlib.error) as error:
        raise InputError(f"is not {kind}, or is damaged") from error


def _check_array(name: str, file: IO[bytes], size: int) -> None:
    try:
        major = npy.read_magic(file)[0]
        read_header = npy.read_array_header_1_0 if major == 1 else npy.read_array_header_2_0
        shape, _, dtype = read_header(file)
    except UNREADABLE as error:
        raise InputError(f"member {name!r} is no array of NumPy") from error
    if dtype.hasobject:
        raise InputError(f"member {name!r} holds pickled objects, which are not read")
    announced = dtype.itemsize
    for length in shape:
        announced *= int(length)
    if announced > size:
        raise InputError(f"member {name!r} announces {announced:,} bytes and holds {size:,}")
