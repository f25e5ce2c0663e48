"""File formats: one file a format.

Names are imported when they are first used: each format brings its own packages.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from bumpstop.lazy import lazy_names

if TYPE_CHECKING:
    from bumpstop.io.matrices import read_matrices, write_matrices
    from bumpstop.io.meshes import LineMesh, read_mesh
    from bumpstop.io.modes import ModeSet, read_modes

__all__ = [
    "FORMATS",
    "LineMesh",
    "ModeSet",
    "read_matrices",
    "read_mesh",
    "read_modes",
    "write_matrices",
]

FORMATS = {
    "netcdf": ".nc",
    "csv": ".csv",
    "parquet": ".parquet",
    "uff": ".uff",
    "vtk": ".vtkhdf",
    "mat": ".mat",
    "wav": ".wav",
}
"""What a response can be written as, and the ending of such files."""

__getattr__ = lazy_names(
    __name__,
    {
        "LineMesh": "meshes",
        "ModeSet": "modes",
        "read_matrices": "matrices",
        "read_mesh": "meshes",
        "read_modes": "modes",
        "write_matrices": "matrices",
    },
)
