"""From a file to modes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from os import PathLike
from pathlib import Path

from bumpstop.errors import InputError
from bumpstop.io.modes.given import refuse_identification
from bumpstop.io.modes.mode_set import ModeSet
from bumpstop.io.modes.npz import read_mode_arrays
from bumpstop.io.modes.table import read_mode_table
from bumpstop.io.modes.uff import read_universal_modes
from bumpstop.io.reading import in_file

__all__ = ["read_modes"]

_READERS: Mapping[str, Callable[[Path], ModeSet]] = {
    ".csv": read_mode_table,
    ".npz": read_mode_arrays,
}
_UNIVERSAL = (".uff", ".unv")


def read_modes(
    path: str | PathLike[str],
    *,
    band: tuple[float, float] | None = None,
    count: int | None = None,
) -> ModeSet:
    """Read modes of another program or of a measurement.

    The format is told by the end of the name: ``.csv`` (a table), ``.npz`` (arrays), ``.uff`` or
    ``.unv`` (a universal file with data sets 55, or with measured functions, data sets 58).

    Parameters
    ----------
    path
        The file.
    band, count
        Where to identify modes of measured functions, in Hz, and how many, as in
        ``identify_modes``.

    Raises
    ------
    InputError
        If the file is missing, truncated or in another format, or modes cannot be identified;
        the message names the file.
    """
    file = Path(path)
    with in_file(file):
        suffix = file.suffix.lower()
        if suffix in _UNIVERSAL:
            return read_universal_modes(file, band, count)
        if suffix not in _READERS:
            hint = f"known: {', '.join([*_READERS, *_UNIVERSAL])}"
            raise InputError("is of no known kind of modes", value=file.suffix, hint=hint)
        refuse_identification(band, count)
        return _READERS[suffix](file)
