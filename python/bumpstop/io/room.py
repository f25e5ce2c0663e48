"""New HDF5 files, for which there is room.

HDF5 does not survive a full disk: what it could not write it tries to write again when the file is
closed, which then cannot be closed at all. So the room that a file takes is reserved first.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py

__all__ = ["new_hdf5"]

SPARE = 1.02
"""What pieces and their indices take beside the numbers in them."""


@contextmanager
def new_hdf5(path: Path, size: int, **options: Any) -> Iterator[h5py.File]:
    """Give a new HDF5 file that will take about so many bytes.

    Raises
    ------
    OSError
        If there is not so much room.
    """
    wanted = int(SPARE * size) + 1_000_000
    with path.open("wb") as file:
        _reserve(file.fileno(), wanted)
    with h5py.File(path, "w", **options) as content:
        # Opening it has given the room back.
        with path.open("r+b") as file:
            _reserve(file.fileno(), wanted)
        yield content
        content.flush()
        end = content.id.get_filesize()
    os.truncate(path, end)


def _reserve(file: int, size: int) -> None:
    """Let a file have so many bytes, where the system can promise them."""
    if hasattr(os, "posix_fallocate"):
        os.posix_fallocate(file, 0, size)
