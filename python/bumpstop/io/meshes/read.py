"""From a file to a LineMesh."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from os import PathLike
from pathlib import Path

from bumpstop.errors import InputError
from bumpstop.io.meshes.aster import read_aster
from bumpstop.io.meshes.gmsh import read_gmsh
from bumpstop.io.meshes.line_mesh import LineMesh
from bumpstop.io.meshes.med import read_med
from bumpstop.io.reading import in_file

__all__ = ["read_mesh"]

_READERS: Mapping[str, Callable[[Path], LineMesh]] = {
    ".msh": read_gmsh,
    ".mail": read_aster,
    ".med": read_med,
    ".mmed": read_med,
}


def read_mesh(path: str | PathLike[str]) -> LineMesh:
    """Read the lines of a mesh, and their groups.

    The format is told by the end of the name: ``.msh`` (Gmsh 2.2 or 4.1 in text form), ``.mail``
    (text mesh of code_aster), ``.med`` or ``.mmed`` (MED). Surfaces and volumes are passed over.

    Raises
    ------
    InputError
        If the file is missing, truncated or in another format, or has no lines; the message
        names the file.
    """
    file = Path(path)
    with in_file(file):
        if file.suffix.lower() not in _READERS:
            hint = f"known: {', '.join(_READERS)}"
            raise InputError("is of no known kind of mesh", value=file.suffix, hint=hint)
        return _READERS[file.suffix.lower()](file)
