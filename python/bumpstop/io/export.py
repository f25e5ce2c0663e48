"""Export: a response to a file whose ending says its format."""

from __future__ import annotations

from importlib import import_module
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from bumpstop.arguments import one_of
from bumpstop.errors import InputError
from bumpstop.files import file_path
from bumpstop.io import FORMATS

if TYPE_CHECKING:
    from bumpstop.response import Response

__all__ = ["export"]


def export(response: Response, path: str | PathLike[str], form: str | None = None) -> None:
    """Write a response, tabulated at its times, in a format that other programs read.

    Parameters
    ----------
    response
        What to write.
    path
        The file; one of that name is replaced once the new one is complete.
    form
        ``netcdf``, ``csv``, ``parquet``, ``uff``, ``vtk``, ``mat`` or ``wav``; as the ending of
        the file says where left out.

    Raises
    ------
    InputError
        If the format is unknown, the response has nothing that it holds, a package for it is
        missing, or the file cannot be written there.
    """
    if form is None:
        form = _told_by(file_path(path))
    one_of("format", form, tuple(FORMATS))
    module = import_module(f"bumpstop.io.{form}")
    getattr(module, f"write_{form}")(response, path)


def _told_by(path: Path) -> str:
    for name, ending in FORMATS.items():
        if path.suffix.lower() == ending:
            return name
    hint = f"known: {', '.join(FORMATS.values())}"
    raise InputError("does not tell a format by its ending", file=str(path), hint=hint)
