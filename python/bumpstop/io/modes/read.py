"""From a file to modes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from os import PathLike
from pathlib import Path

from bumpstop.errors import InputError
from bumpstop.io.modes.mode_set import ModeSet
from bumpstop.io.modes.npz import read_mode_arrays
from bumpstop.io.modes.table import read_mode_table
from bumpstop.io.modes.uff import read_universal_modes
from bumpstop.io.reading import in_file

__all__ = ["read_modes"]

_READERS: Mapping[str, Callable[[Path], ModeSet]] = {
    ".csv": read_mode_table,
    ".npz": read_mode_arrays,
    ".uff": read_universal_modes,
    ".unv": read_universal_modes,
}


def read_modes(path: str | PathLike[str]) -> ModeSet:
    """Read modes of another program or of a measurement.

    The format is told by the end of the name: ``.csv`` (a table), ``.npz`` (arrays), ``.uff`` or
    ``.unv`` (a universal file with data sets 55).

    Raises
    ------
    InputError
        If the file is missing, truncated or in another format; the message names the file.
    """
    file = Path(path)
    with in_file(file):
        if file.suffix.lower() not in _READERS:
            hint = f"known: {', '.join(_READERS)}"
            raise InputError("is of no known kind of modes", value=file.suffix, hint=hint)
        return _READERS[file.suffix.lower()](file)
